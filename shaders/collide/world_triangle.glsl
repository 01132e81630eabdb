// SPDX-License-Identifier: MIT
struct WorldTriangle
{
    dvec3 a;
    dvec3 b;
    dvec3 c;
};
