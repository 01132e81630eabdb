// Decides which geometries a sync builds at a time, so that their scratch memory stays within a budget, and whether a
// top level is rebuilt or refitted. Pure functions.
#pragma once

#include <algorithm>
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
inline Batches cut_into_batches(std::span<const std::uint64_t> scratch_bytes, std::uint64_t budget) {
    Batches batches;
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < scratch_bytes.size(); ++i) {
        if (i == 0 || bytes > budget || scratch_bytes[i] > budget - bytes) {
            batches.runs.push_back({i, 0});
            bytes = 0;
        }
        ++batches.runs.back().count;
        bytes += scratch_bytes[i];
        batches.scratch_bytes = std::max(batches.scratch_bytes, bytes);
    }
    return batches;
}

struct SceneChange {
    bool is_built = false;          // there is a top level
    bool was_moved = false;         // before: top levels that never moved are built so that they cannot be refitted
    bool has_structure = false;     // something was pushed, erased or replaced
    bool has_new_geometry = false;  // rebuilt: its instances may have been inactive, which a refit cannot change
    bool has_degraded = false;      // refits have made it bad
    std::size_t built_count = 0;    // instances of the top level as it was built
    std::size_t count = 0;          // the present number: Vulkan forbids an update to change it
};

constexpr bool must_build(const SceneChange& change) {
    return !change.is_built || !change.was_moved || change.has_structure || change.has_new_geometry ||
           change.has_degraded || change.built_count != change.count;
}

}  // namespace twinray
