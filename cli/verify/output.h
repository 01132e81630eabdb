// SPDX-License-Identifier: MIT
// What `twinray verify` was asked for, and what it says.
#pragma once

#include "cli/common.h"
#include "cli/verify/outcome.h"
#include <twinray/tlas.h>

namespace twinray::cli {

struct VerifyOptions {
    CommonOptions common;
    std::filesystem::path scene, rays;
    std::filesystem::path replay;   // in place of a scene
    std::filesystem::path replays;  // folder; "" = only faults of ours are written
    std::size_t random = 100'000;
    std::size_t aimed = 10'000;
    Level level = Level::watertight;
};

// To stdout.
void print(const RaySet& set, const Outcome& outcome, bool has_hardware);

// What one set of rays gave, and where.
struct JudgedSet {
    const Context& context;
    const Scene& scene;
    const RaySet& set;
    const Outcome& outcome;
    const HwTlas* hw;  // may be null
};
// To the JSON file of the options, if there is one.
void append_records(const VerifyOptions& options, const JudgedSet& judged);

}  // namespace twinray::cli
