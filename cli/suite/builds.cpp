// SPDX-License-Identifier: MIT
// Structure: build and refit.
#include "cli/suite/case_run.h"

namespace twinray::suite {

std::vector<SuiteCase> build_cases() {
    return {
        {"B01", "all centroids equal", "builds; depth <= ceil(log2 n)+bits", "builds; depth <= ceil(log2 n)+bits",
         nullptr, "not written yet"},
        {"B02", "geometric series 2^-60..2^59 (one long chain)", "all 120 found (lavapipe: 120/120); depth <= bound",
         "all 120 found (lavapipe: 120/120); depth <= bound", nullptr, "not written yet"},
        {"B03", "collinear/coplanar centroids", "builds", "builds", nullptr, "not written yet"},
        {"B04", "Morton collision clusters: 1e6 in one cell + one outlier at 1e6",
         "correct; 63-bit chosen; time ratio reported", "correct; 63-bit chosen; time ratio reported", nullptr,
         "not written yet"},
        {"B05", "huge extents +-3e38", "no overflow in centroid/extent", "no overflow in centroid/extent", nullptr,
         "not written yet"},
        {"B06", "refit: 1e4 random-walk updates, then compare with rebuild", "identical hits; SAH ratio reported",
         "identical hits; SAH ratio reported", nullptr, "not written yet"},
        {"B07", "refit after all vertices collapse to a point and back", "identical to rebuild", "identical to rebuild",
         nullptr, "not written yet"},
        {"B08", "stack-depth adversary (depth 87)", "overflow flag never silently set",
         "overflow flag never silently set", nullptr, "not written yet"},
        {"B09", "determinism: 10 builds", "identical node hash", "identical node hash", nullptr, "not written yet"},
        {"B10", "validation: every child inside parent exactly, every active primitive exactly once, no cycles",
         "0 violations, every build in debug", "0 violations, every build in debug", nullptr, "not written yet"},
        {"B11", "quantised nodes decode contains exact box", "0 violations", "0 violations", nullptr,
         "not written yet"},
        {"B12", "LBVH vs brute force, n=1..300 all sizes", "identical", "identical", nullptr, "not written yet"},
        {"B13", "subgroup sizes 8/16/32/64 and workgroup sizes", "identical", "identical", nullptr, "not written yet"},
    };
}

}  // namespace twinray::suite
