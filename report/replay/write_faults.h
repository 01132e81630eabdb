// SPDX-License-Identifier: MIT
// Faulty rays as files.
#pragma once

#include <functional>
#include <span>

#include "report/replay/replay.h"
#include "validation/verify/comparison.h"

namespace twinray::replay {

// A file for each fault, "random-SW_LEAK-1.json" of the set "random", into the folder, which is made; without
// `with_driver` those of ours alone. `common`: what all have in
// common, its backend that of the driver's; `reference` tells what is right. Returns how
// many files were written.
std::size_t write_faults(const std::filesystem::path& folder, const std::string& set, std::span<const Fault> faults,
                         bool with_driver, Replay common, const std::function<ReferenceHit(const Ray&)>& reference);

}  // namespace twinray::replay
