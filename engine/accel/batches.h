// SPDX-License-Identifier: MIT
// Decides which geometries a sync builds at a time, so that their scratch memory stays within a budget.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace twinray {

// Builds that share scratch memory, one run after the other.
struct Batches {
    struct Run {
        std::size_t first = 0, count = 0;
    };
    std::vector<Run> runs;
    std::uint64_t scratch_bytes = 0;  // the need of the largest run
};

// Cuts builds, in order, into runs as long as their scratch together fits into `budget`. One that exceeds it alone is a
// run of its own.
Batches cut_into_batches(std::span<const std::uint64_t> scratch_bytes, std::uint64_t budget);

}  // namespace twinray
