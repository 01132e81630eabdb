// SPDX-License-Identifier: MIT
// What a Vulkan device can do, asked of its driver, and what to switch on when one is created.
#pragma once

#include <vector>

#include "engine/core/feature_chain.h"

namespace twinray {

// Asks the driver. Functions of the instance level must be loaded.
DeviceFacts query_device_facts(const VulkanFunctions& vk, VkPhysicalDevice device);
std::vector<VkPhysicalDevice> physical_devices(const VulkanFunctions& vk, VkInstance instance);
std::vector<VkExtensionProperties> device_extensions(const VulkanFunctions& vk, VkPhysicalDevice device);

// First queue family with compute; -1 if none.
int compute_queue_family(const VulkanFunctions& vk, VkPhysicalDevice device);

// The same for a physical device of a host's instance. Throws Error for an instance below Vulkan 1.1.
DeviceFacts query_device_facts(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                               VkPhysicalDevice device);

// The facts of a device that a host created with `info`: what it enabled, not what else the driver supports. For
// AdoptedDevice::enabled.
DeviceFacts enabled_facts(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                          VkPhysicalDevice device, const VkDeviceCreateInfo& info);

// What twinray enables on a device, told before the device is created: extensions, features, and a sentence for each in
// in_words(). What the device lacks is left out; only hardware ray tracing may be lacking.
class DeviceRequirements {
  public:
    // `supported`: from query_device_facts.
    explicit DeviceRequirements(const DeviceFacts& supported);
    DeviceRequirements(const DeviceRequirements&) = delete;
    DeviceRequirements& operator=(const DeviceRequirements&) = delete;

    const DeviceFacts& supported() const { return supported_; }
    std::vector<Requirement> in_words() const { return requirements_of(supported_); }

    // For a device that enables nothing else: features() is its VkDeviceCreateInfo::pNext.
    const std::vector<const char*>& extensions() const { return extensions_; }
    const void* features() const { return alone_.pNext; }

    // For a device of a host that enables things of its own: adds both to `info`. A feature is switched on in the
    // struct of the host's chain that has it (of the feature alone or of a Vulkan version; that struct is written to);
    // where there is none, one of ours is put before the chain, into which pEnabledFeatures moves. Until
    // vkCreateDevice `info` refers to this object. Once.
    void add_to(VkDeviceCreateInfo& info);

  private:
    void switch_on(VkDeviceCreateInfo& info, FeatureStructs& structs) const;

    DeviceFacts supported_;
    std::vector<const char*> extensions_, all_extensions_;
    VkDeviceCreateInfo alone_{};
    FeatureStructs alone_structs_, added_structs_;
};

}  // namespace twinray
