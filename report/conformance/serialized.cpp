// SPDX-License-Identifier: MIT
#include "report/conformance/serialized.h"

#include <cstring>

namespace twinray::conformance {

std::uint64_t Serialized::word(std::size_t index) const {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + header_bytes + index * sizeof value, sizeof value);
    return value;
}

std::span<const std::uint8_t, VK_UUID_SIZE> Serialized::driver_uuid() const {
    return std::span<const std::uint8_t, VK_UUID_SIZE>(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                                       VK_UUID_SIZE);
}

std::span<const std::uint8_t, VK_UUID_SIZE> Serialized::compatibility_uuid() const {
    return std::span<const std::uint8_t, VK_UUID_SIZE>(
        reinterpret_cast<const std::uint8_t*>(bytes.data() + VK_UUID_SIZE), VK_UUID_SIZE);
}

std::vector<std::uint64_t> Serialized::handles() const {
    std::vector<std::uint64_t> addresses;
    for (std::size_t i = 0; i < handle_count(); ++i) addresses.push_back(word(3 + i));
    return addresses;
}

void Serialized::set_handles(std::span<const std::uint64_t> addresses) {
    std::memcpy(bytes.data() + header_bytes + 3 * sizeof(std::uint64_t), addresses.data(), addresses.size_bytes());
}

}  // namespace twinray::conformance
