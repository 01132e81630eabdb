// SPDX-License-Identifier: MIT
#include "samples/support/devices.h"

#include <utility>

namespace twinray::samples {
namespace {

// Larger is better.
std::pair<bool, int> rank(const DeviceProperties& device) {
    return {missing_for_hardware(device).empty(), -static_cast<int>(device.kind)};
}

}  // namespace

std::optional<std::size_t> best_device(std::span<const DeviceProperties> devices, const std::string& request) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const bool is_named = devices[i].name.find(request) != std::string::npos || std::to_string(i) == request;
        if (!is_named || !missing_for_software(devices[i]).empty()) continue;
        if (!best || rank(devices[i]) > rank(devices[*best])) best = i;
    }
    return best;
}

}  // namespace twinray::samples
