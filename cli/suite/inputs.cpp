// SPDX-License-Identifier: MIT
// Invalid and special input.
#include "cli/suite/case_run.h"

namespace twinray::suite {

std::vector<SuiteCase> input_cases() {
    return {
        {"N01", "NaN.x vertex (one of many)", "inactive; others hit; id numbering kept",
         "inactive; others hit; id numbering kept", nullptr, "not written yet"},
        {"N02", "NaN.y/.z vertex", "sanitised to inactive + counted warning", "sanitised to inactive + counted warning",
         nullptr, "not written yet"},
        {"N03", "+-Inf vertex", "as N02; whole BLAS unaffected (lavapipe raw: all miss)",
         "as N02; whole BLAS unaffected (lavapipe raw: all miss)", nullptr, "not written yet"},
        {"N04", "NaN/Inf in ray origin/direction", "miss + status bit; no hang; other rays of the subgroup unaffected",
         "miss + status bit; no hang; other rays of the subgroup unaffected", nullptr, "not written yet"},
        {"N05", "tmin>tmax; tmin=tmax; tmin<0; tmax<0; NaN", "miss; negative tmin clamped to 0 and counted",
         "miss; negative tmin clamped to 0 and counted", nullptr, "not written yet"},
        {"N06", "zero direction", "miss + status", "miss + status", nullptr, "not written yet"},
        {"N07", "exact t=tmin, t=tmax", "exclusive: miss both", "exclusive: miss both", nullptr, "not written yet"},
        {"N08", "index out of range; index count not multiple of 3; stride < 12; misaligned",
         "host error naming mesh, index, limit; never GPU read out of bounds (robustBufferAccess as a second line)",
         "host error naming mesh, index, limit; never GPU read out of bounds (robustBufferAccess as a second line)",
         nullptr, "not written yet"},
        {"N09", "0 triangles; 1 triangle; 2 triangles; 0 instances; empty BLAS among others",
         "valid structure; correct hits; degenerate instance invisible",
         "valid structure; correct hits; degenerate instance invisible", nullptr, "not written yet"},
        {"N10", "2^24-1, 2^24, 2^24+1 triangles; 2^24+1 instances", "split or named limit error",
         "split or named limit error", nullptr, "not written yet"},
        {"N11", "64-bit sized buffers (> maxStorageBufferRange, > 4 GiB)", "chunk or named error",
         "chunk or named error", nullptr, "not written yet"},
        {"N12", "mask 0, mask bits, cull flags x mirrored x flip flag (all 64 combinations)",
         "equals spec table and hw", "equals spec table and hw", nullptr, "not written yet"},
        {"N13", "device lost / allocation failure injected", "clean error, no leak", "clean error, no leak", nullptr,
         "not written yet"},
    };
}

}  // namespace twinray::suite
