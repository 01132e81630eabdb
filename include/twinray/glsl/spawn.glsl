// SPDX-License-Identifier: MIT
// Safe points for rays to start from, for kernels that trace by twinray/glsl/query.glsl or write rays for a batch:
//
//     Placement placement = placement_of(AT(push.instances, 0));   // AbstractAccel::instance_buffer().records
//     Corners corners = corners_of(push.positions, push.indices, hit.primitive_index);
//     SurfacePoint point = surface_point(placement, corners, vec2(hit.u, hit.v));
//     Ray shadow = Ray(spawn_position(point, dot(to_light, point.normal) > 0.0), 0.0, to_light, 1.0);
//
// shaders/shared/spawn.h says what is guaranteed.
#ifndef TWINRAY_SPAWN_GLSL
#define TWINRAY_SPAWN_GLSL
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/spawn.h"
#endif
