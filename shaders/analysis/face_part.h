// SPDX-License-Identifier: MIT
// A part of a triangle, and points of it.
#ifndef TWINRAY_ANALYSIS_FACE_PART_H
#define TWINRAY_ANALYSIS_FACE_PART_H
#include "twinray/glsl/sampling.h"

// A convex polygon in barycentric coordinates u, v of the triangle, as two triangles: corners 0, 1, 2 and 0, 2, 3.
struct FacePart
{
    vec2 corners[4];
    float first; // the first triangle's share of the area: 1 where there is no other
};

// Returns a point uniform by area, for u uniform in the unit square: its barycentric coordinates.
FUNC vec2 sample_part(FacePart part, vec2 u)
{
    bool is_first = u.x < part.first;
    float along = is_first ? u.x / part.first : (u.x - part.first) / (1.0f - part.first);
    vec2 at = sample_triangle(vec2(along, u.y));
    vec2 middle = is_first ? part.corners[1] : part.corners[2];
    vec2 last = is_first ? part.corners[2] : part.corners[3];
    return part.corners[0] + (middle - part.corners[0]) * at.x + (last - part.corners[0]) * at.y;
}
#endif
