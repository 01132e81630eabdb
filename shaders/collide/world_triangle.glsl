// SPDX-License-Identifier: MIT
// Triangles in world space, in float64.
struct WorldTriangle
{
    dvec3 a;
    dvec3 b;
    dvec3 c;
};
