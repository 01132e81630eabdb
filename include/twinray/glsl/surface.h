// SPDX-License-Identifier: MIT
// The surface at a hit on a triangle, for kernels (twinray/glsl/surface.glsl) and the host (AbstractAccel::surfaces()).
#ifndef TWINRAY_SURFACE_H
#define TWINRAY_SURFACE_H
#include "twinray/glsl/surface_point.h"

// A surface point in world space.
struct Surface {
    SurfacePoint point;
    float t;         // of the ray, recomputed: the same bits on both accelerators
    vec2 uv;         // barycentrics: the point is (1-u-v) v0 + u v1 + v v2
    uvec3 vertices;  // indices into the mesh
    // 1: its front is seen, by the rules of culling. point.normal is on the side from which vertices are
    // counter-clockwise in object space, whatever flip_facing says.
    uint is_front;
    // Shading normal, unit, on the side of point.normal whatever side the mesh's normals are on: the pushed normals
    // transformed by the inverse transpose; point.normal if there are none.
    vec3 normal;
    vec4 tangent;  // unit; the bitangent is cross(normal, tangent.xyz) * tangent.w. 0 if none were pushed
    vec2 uv0;      // texture coordinates; 0 if none were pushed
    vec2 uv1;
    vec4 color;           // 1 if none were pushed
    uint custom_index;    // of the instance
    uint face_metadata;   // custom_index if that is not 0, else the face's own; 0 if none was pushed
    uint instance_index;  // as in Hit
    uint primitive_index;
    uint is_hit;  // 0: a miss, and all fields are 0
};
BUFFER_OF(Surface, 4);
#endif
