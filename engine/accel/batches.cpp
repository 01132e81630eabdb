// SPDX-License-Identifier: MIT
#include "engine/accel/batches.h"

#include <algorithm>

namespace twinray {

Batches cut_into_batches(std::span<const std::uint64_t> scratch_bytes, std::uint64_t budget) {
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

}  // namespace twinray
