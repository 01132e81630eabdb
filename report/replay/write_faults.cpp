// SPDX-License-Identifier: MIT
#include "report/replay/write_faults.h"

#include <map>

#include "engine/core/error.h"

namespace twinray::replay {

std::size_t write_faults(const std::filesystem::path& folder, const std::string& set, std::span<const Fault> faults,
                         bool with_driver, Replay common, const std::function<ReferenceHit(const Ray&)>& reference) {
    std::filesystem::create_directories(folder);
    const std::string backend_of_driver = common.backend;
    std::map<HitClass, std::size_t> numbers;
    std::size_t written = 0;
    for (const Fault& fault : faults) {
        if (!with_driver && !fault.is_of_software) continue;
        common.backend = fault.is_of_software ? "sw" : backend_of_driver;
        common.kind = name_of(fault.kind);
        common.ray = fault.ray;
        common.answer = fault.answer;
        common.reference = reference(fault.ray);
        write(folder / text(set, '-', common.kind, '-', ++numbers[fault.kind], ".json"), common);
        ++written;
    }
    return written;
}

}  // namespace twinray::replay
