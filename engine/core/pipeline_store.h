// SPDX-License-Identifier: MIT
// Stores compiled pipelines beyond the process: one file for each device and driver in a folder.
#pragma once

#include <vulkan/vulkan_core.h>

#include <functional>
#include <string>
#include <string_view>

#include "engine/core/files.h"

namespace twinray {

class PipelineStore {
  public:
    static constexpr std::size_t most_files = 8;            // the oldest of other drivers are removed
    static constexpr std::size_t most_bytes = 64ull << 20;  // larger ones are dropped, to begin anew

    // Has no folder: nothing is kept.
    PipelineStore() = default;
    PipelineStore(std::filesystem::path folder, const VkPhysicalDeviceProperties& driver);

    // Returns the data that an earlier run of this driver saved; empty if there is none, or if it belongs to another
    // driver or cannot be read: `log` gets a sentence then.
    Bytes load(const std::function<void(std::string_view)>& log) const;
    // Replaces it, whole or not at all; removes it if load() would refuse `pipelines`: Mesa 26.2's lavapipe gives 20
    // bytes, fewer than Vulkan's header has. The reason against it goes to `log`.
    void save(std::span<const std::byte> pipelines, const std::function<void(std::string_view)>& log) const noexcept;

    const std::filesystem::path& file() const { return file_; }

  private:
    void replace(std::span<const std::byte> pipelines) const;

    std::filesystem::path file_;
    VkPhysicalDeviceProperties driver_{};
};

}  // namespace twinray
