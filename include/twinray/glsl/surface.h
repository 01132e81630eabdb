// SPDX-License-Identifier: MIT
// What lies where a ray met a triangle, as kernels and the host get it: of twinray/glsl/surface.glsl, and of
// AbstractAccel::surfaces().
#ifndef TWINRAY_SURFACE_H
#define TWINRAY_SURFACE_H
#include "twinray/glsl/surface_point.h"

// World space.
struct Surface {
    SurfacePoint point;
    float t;         // of the ray, rebuilt: the same bits on both accelerators
    vec2 uv;         // barycentrics: the point is (1-u-v) v0 + u v1 + v v2
    uvec3 vertices;  // indices into the mesh
    // 1: its front is seen, as culling has it. point.normal is of the side on which vertices turn counter-clockwise in
    // object space, whatever flip_facing says.
    uint is_front;
    // Shading normal, unit, on the side of point.normal whatever side the mesh's normals are on: by the inverse
    // transpose of the normals that were pushed; point.normal where there are none.
    vec3 normal;
    vec4 tangent;  // unit; the bitangent is cross(normal, tangent.xyz) * tangent.w. 0 where none were pushed
    vec2 uv0;      // texture coordinates; 0 where none were pushed
    vec2 uv1;
    vec4 color;           // 1 where none were pushed
    uint custom_index;    // of the instance
    uint face_metadata;   // custom_index if that is not 0, else the face's own; 0 where none was pushed
    uint instance_index;  // as in Hit
    uint primitive_index;
    uint is_hit;  // 0: a miss, and all is 0
};
BUFFER_OF(Surface, 4);
#endif
