// SPDX-License-Identifier: MIT
// Triangle shape.
#include "cli/suite/case_run.h"

namespace twinray::suite {

std::vector<SuiteCase> shape_cases() {
    return {
        {"T01", "slivers, aspect 1e2..1e8..1e30, aimed inside", "miss", "0 exact-sign misses", nullptr,
         "not written yet"},
        {"T02", "needle fan closed into a disc, 1e5 needles", "leak at hub", "0", nullptr, "not written yet"},
        {"T03", "grazing cos=1e-1..1e-8", "t ulp", "refined <=1 ulp; f32 within its bound (lavapipe max 306)", nullptr,
         "not written yet"},
        {"T04", "ray in the triangle's plane", "hits", "0 (area 0 to no face)", nullptr, "not written yet"},
        {"T05", "ray in the plane through an edge of a closed box", "parity", "even; entry found through neighbours",
         nullptr, "not written yet"},
        {"T06", "degenerate: point, line, two equal vertices, index-equal", "hits", "0; BVH intact", nullptr,
         "not written yet"},
        {"T07", "near-degenerate: area 1e-40 relative", "class", "exact sign", nullptr, "not written yet"},
        {"T08", "duplicate triangles x2, x4, x1e5", "id", "lowest id, run-to-run identical", nullptr,
         "not written yet"},
        {"T09", "coplanar overlapping different tessellations", "id, t", "t within 1 ulp; id by rule", nullptr,
         "not written yet"},
        {"T10", "shells 1 ulp apart (z=1..1+7ulp), origin at distance <=1 and at 10", "order",
         "correct when t's differ in f32; else equal t and lowest id (lavapipe returned prim 5 of 7: all equal t)",
         nullptr, "not written yet"},
        {"T11", "z-fight pair at 1e-7 relative, 1e6 rays", "flips", "level 3: 0 wrong order", nullptr,
         "not written yet"},
        {"T12", "huge triangle 1e18 edges, unit scene", "t, bary", "refined <=2 ulp", nullptr, "not written yet"},
        {"T13", "shear-axis ties abs dx = abs dy = abs dz", "leaks", "0", nullptr, "not written yet"},
        {"T14", "rays along edges, diagonals of a cube, from a vertex", "hits", "defined: tmin exclusive to 0 self",
         nullptr, "not written yet"},
    };
}

}  // namespace twinray::suite
