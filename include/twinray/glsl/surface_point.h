// SPDX-License-Identifier: MIT
// A point of a triangle, with a bound of its errors: twinray/glsl/spawn.h makes it.
#ifndef TWINRAY_SURFACE_POINT_H
#define TWINRAY_SURFACE_POINT_H

// The point, its normals, and how far a ray must start from it.
struct SurfacePoint {
    vec3 position;  // world; up to `offset` beside the triangle, as an accelerator sees it
    // geometric, unit, world; of the side on which the vertices turn counter-clockwise in object space
    vec3 normal;
    float offset;        // world: how far along the normal a ray must start to be clear of the triangle
    float feature;       // world: the least height of the triangle. offset / feature is the price: what lies within
                         // `offset` of the triangle is skipped, and near 1 float32 cannot resolve the triangle
    vec3 normal_object;  // unit
    vec3 error_object;   // bound of how far the point is from the triangle, as an accelerator sees it; by component
};
#endif
