// SPDX-License-Identifier: MIT
// A structure as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace twinray::conformance {

// What vkCmdCopyAccelerationStructureToMemoryKHR writes, on the host.
struct Serialized {
    std::vector<std::byte> bytes;

    std::span<const std::uint8_t, VK_UUID_SIZE> driver_uuid() const;
    std::span<const std::uint8_t, VK_UUID_SIZE> compatibility_uuid() const;
    std::uint64_t serialized_bytes() const { return word(0); }
    std::uint64_t deserialized_bytes() const { return word(1); }
    std::uint64_t handle_count() const { return word(2); }
    void set_handles(std::span<const std::uint64_t> addresses);  // of bottom levels, which the file's are replaced by
    std::vector<std::uint64_t> handles() const;

    static constexpr std::size_t header_bytes = 2 * VK_UUID_SIZE;  // before the numbers

  private:
    std::uint64_t word(std::size_t index) const;
};

}  // namespace twinray::conformance
