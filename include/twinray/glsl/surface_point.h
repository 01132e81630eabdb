// SPDX-License-Identifier: MIT
// A point of a triangle, with a bound of its errors; twinray/glsl/spawn.h makes it.
#ifndef TWINRAY_SURFACE_POINT_H
#define TWINRAY_SURFACE_POINT_H

// The point, its normals, and the distance from it at which a ray must start.
struct SurfacePoint {
    vec3 position;  // world; up to `offset` beside the triangle, as an accelerator sees it
    // geometric, unit, world; on the side from which the vertices are counter-clockwise in object space
    vec3 normal;
    float offset;        // world: the distance along the normal at which a ray must start to be clear of the triangle
    float feature;       // world: the least height of the triangle. offset / feature tells the loss: surfaces within
                         // `offset` of the triangle are skipped, and near 1 float32 cannot resolve the triangle
    vec3 normal_object;  // unit
    vec3 error_object;   // bound of the distance of the point from the triangle as an accelerator sees it; by component
};
#endif
