// SPDX-License-Identifier: MIT
// Compiled pipelines that outlive the process: one file for each device and driver in a folder.
#pragma once

#include <vulkan/vulkan_core.h>

#include <functional>
#include <string>
#include <string_view>

#include "engine/core/files.h"

namespace twinray {

class PipelineStore {
  public:
    static constexpr std::size_t most_files = 8;            // of other drivers the oldest are removed
    static constexpr std::size_t most_bytes = 64ull << 20;  // what is larger is dropped, to begin anew

    // An empty folder: nothing is kept.
    PipelineStore() = default;
    PipelineStore(std::filesystem::path folder, const VkPhysicalDeviceProperties& driver);

    // What an earlier run of this driver saved; empty where there is none, or what there is belongs to another or
    // cannot be read: `log` gets a sentence then.
    Bytes load(const std::function<void(std::string_view)>& log) const;
    // Replaces it, whole or not at all; removes it where load() would refuse `pipelines`: Mesa 26.2's lavapipe gives
    // 20 bytes, fewer than Vulkan's header has. What stands against it goes to `log`.
    void save(std::span<const std::byte> pipelines, const std::function<void(std::string_view)>& log) const noexcept;

    const std::filesystem::path& file() const { return file_; }

  private:
    void replace(std::span<const std::byte> pipelines) const;

    std::filesystem::path file_;
    VkPhysicalDeviceProperties driver_{};
};

}  // namespace twinray
