// SPDX-License-Identifier: MIT
// A device that somebody else created: what its owner tells, and what is checked before it is used.
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "engine/core/allocator.h"
#include "engine/core/device_facts.h"

namespace twinray {

using Log = std::function<void(std::string_view)>;

// A device that the host created and keeps. Its objects are used, never changed, waited idle on or destroyed; all of
// them, what the functions capture included, must outlive the Context.
struct AdoptedDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  // must support compute
    std::uint32_t queue_family = 0;
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  // required
    std::uint32_t api_version = 0;  // VkApplicationInfo::apiVersion of the instance; at least 1.2
    // What was *enabled* on the device: told by the host, never guessed. enabled_facts() makes it of the
    // VkDeviceCreateInfo that the device was created with.
    DeviceFacts enabled;
    std::function<void()> lock_queue;  // held around each submission; may be empty
    std::function<void()> unlock_queue;
    AllocatorHooks allocator;                         // none: memory comes from an allocator of twinray's own
    VkPipelineCache pipeline_cache = VK_NULL_HANDLE;  // null: one of twinray's own
    std::optional<double> most_submission_seconds;    // as in ContextDesc
    Log log;
};

// What twinray may use of it: the features of `adopted.enabled`, all other facts from the driver. Throws Error, naming
// what the host has to change, unless twinray can run on the device: something needed is not enabled, the queue family
// has no compute, or `enabled` claims what the device does not support or the VkDevice was not created with. The
// handles must be set and the functions of all levels loaded.
DeviceFacts check_adoption(const AdoptedDevice& adopted, const VulkanFunctions& vk);

}  // namespace twinray
