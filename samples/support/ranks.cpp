// SPDX-License-Identifier: MIT
#include "samples/support/ranks.h"

#include <vector>

namespace twinray::samples {

std::size_t device_of_rank(std::span<const DeviceProperties> devices, uint local_index) {
    const int best = choose_device(devices, "").index;
    if (best < 0) return 0;
    const auto is_alike = [&](const DeviceProperties& device) {
        return device.kind == devices[static_cast<std::size_t>(best)].kind && missing_for_software(device).empty();
    };
    std::vector<std::size_t> alike;
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (is_alike(devices[i])) alike.push_back(i);
    return alike[local_index % alike.size()];
}

}  // namespace twinray::samples
