// SPDX-License-Identifier: MIT
// Instances.
#include "cli/suite/case_run.h"

namespace twinray::suite {

std::vector<SuiteCase> instance_cases() {
    return {
        {"I01", "identity instance vs no-TLAS path", "bit identity", "identical", nullptr, "not written yet"},
        {"I02", "random rigid, 1e4", "miss, t", "0 leaks; absd t <= 8gamma3*scale", nullptr, "not written yet"},
        {"I03", "non-uniform scale 1:1e6", "miss, normals", "0; normal by inverse transpose, rel. 1e-6", nullptr,
         "not written yet"},
        {"I04", "mirrored (det<0)", "facing", "object-space rule", nullptr, "not written yet"},
        {"I05", "near-singular, cond 1e2..1e12", "rho, miss", "flagged above threshold; never silently wrong", nullptr,
         "not written yet"},
        {"I06", "singular, NaN matrix", "error", "named error", nullptr, "not written yet"},
        {"I07", "1e5 instances identical AABB", "time, id", "terminates; lowest id; stack no overflow", nullptr,
         "not written yet"},
        {"I08", "1e6 instances in a line, in a point, on a shell", "depth, time", "depth <= bound", nullptr,
         "not written yet"},
        {"I09", "translation 1e7, unit object, camera beside it", "t, jitter", "level 2 <=2e-6", nullptr,
         "not written yet"},
        {"I10", "object offset cancelled by instance", "self-hits", "0 (NVIDIA offset)", nullptr, "not written yet"},
        {"I11", "rotation about random axes of flat (zero-thickness) BLAS", "box misses", "0", nullptr,
         "not written yet"},
        {"I12", "instance box touching the ray only by rounding", "culled", "0", nullptr, "not written yet"},
        {"I13", "same BLAS under 2^k uniform scale", "identity", "identical ids,u,v", nullptr, "not written yet"},
    };
}

}  // namespace twinray::suite
