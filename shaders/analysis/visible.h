// SPDX-License-Identifier: MIT
// Rays from each point along each vector, and which of them hit nothing.
#ifndef TWINRAY_ANALYSIS_VISIBLE_H
#define TWINRAY_ANALYSIS_VISIBLE_H
#include "twinray/glsl/ray.h"

struct VisibleArgs {
    Floats points;   // three each
    Floats vectors;  // likewise
    Floats normals;  // of the points, or absent
    REF(Ray) rays;   // of a tile: by point, then by vector; one that leaves the back of its point ends before it begins
    REF(Hit) hits;
    Uints answers;  // a byte a ray
    uint first_point;
    uint ray_count;
    uint vector_count;
    float t_near;
    float t_far;
    float reach;  // the largest coordinate of the scene
};
#endif
