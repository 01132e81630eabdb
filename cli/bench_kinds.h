// SPDX-License-Identifier: MIT
// `twinray bench --moves`, `--ladder` and `--trees`.
#pragma once

#include "bench/run.h"
#include "cli/common.h"

namespace twinray::cli {

// N instances that a kernel moves, refitted and rebuilt.
void bench_moves(const CommonOptions& options, std::size_t count, std::size_t rounds);
// What each feature costs a scene that does not need it, in time and in memory.
void bench_ladder(const CommonOptions& options, const std::string& scene, const bench::RunOptions& run);
// What trees of each layout and build quality are like: counts, not times.
void bench_trees(const CommonOptions& options, const std::string& scene, const bench::RunOptions& run);

}  // namespace twinray::cli
