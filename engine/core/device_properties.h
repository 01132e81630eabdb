// SPDX-License-Identifier: MIT
// What a Vulkan device can do, asked of its driver, and what to switch on when one is created.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <twinray/context.h>

namespace twinray {

struct VulkanTable;

// A feature that twinray knows, in the chains of structs in which Vulkan reports and enables features.
struct FeatureBit {
    bool DeviceProperties::*fact;
    const char* name;
    VkStructureType own;  // the struct of the feature alone, and where in it
    std::size_t own_offset;
    VkStructureType gathered;  // the struct of the Vulkan version that took the feature in; `own` where none has
    std::size_t gathered_offset;
};
std::span<const FeatureBit> feature_bits();

// The bit of a feature in whichever struct of a chain holds it; null if none does.
VkBool32* find_bit(VkBaseOutStructure* chain, const FeatureBit& bit);

// Which features and extensions a device has that was created with `info`; the other properties stay.
void state_features(const VkDeviceCreateInfo& info, DeviceProperties& properties);

// The first feature that `told` has and `supported` lacks; null if there is none.
const char* feature_beyond(const DeviceProperties& told, const DeviceProperties& supported);

// Asks the driver. Functions of the instance level must be loaded.
DeviceProperties query_device_properties(const VulkanTable& vk, VkPhysicalDevice device);
std::vector<VkPhysicalDevice> physical_devices(const VulkanTable& vk, VkInstance instance);
std::vector<VkExtensionProperties> device_extensions(const VulkanTable& vk, VkPhysicalDevice device);

// First queue family with compute; -1 if none.
int compute_queue_family(const VulkanTable& vk, VkPhysicalDevice device);

}  // namespace twinray
