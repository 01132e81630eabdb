// SPDX-License-Identifier: MIT
// Hit points of triangles, and safe starting points for further rays, in kernels that trace by twinray/glsl/query.glsl
// or write rays for a batch:
//
//     Placement placement = placement_of(AT(push.instances, 0));   // AbstractAccel::instance_buffer().records
//     TriangleVertices vertices = vertices_of(push.positions, push.indices, hit.primitive_index);
//     SurfacePoint point = surface_point(placement, vertices, vec2(hit.u, hit.v));
//     Ray shadow = Ray(spawn_position(point, dot(to_light, point.normal) > 0.0), 0.0, to_light, 1.0);
//
// twinray/glsl/spawn.h states the guarantees; crossing_of() in crossing.h recomputes t, u and v of a hit. Accelerators
// with AccelOptions::keeps_surfaces hold the meshes themselves: see twinray/glsl/surface.glsl.
#ifndef TWINRAY_SPAWN_GLSL
#define TWINRAY_SPAWN_GLSL
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/crossing.h"
#endif
