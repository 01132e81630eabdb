// SPDX-License-Identifier: MIT
// Queries a Vulkan device's properties from its driver, and lists the features to enable when one is created.
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
    VkStructureType gathered;  // the struct of the Vulkan version that includes the feature; `own` if none does
    std::size_t gathered_offset;
};
std::span<const FeatureBit> feature_bits();

// Returns the bit of a feature in the struct of a chain that holds it; null if none does.
VkBool32* find_bit(VkBaseOutStructure* chain, const FeatureBit& bit);

// Sets the features and extensions of a device that was created with `info`; the other properties stay.
void state_features(const VkDeviceCreateInfo& info, DeviceProperties& properties);

// Returns the first feature that `told` has and `supported` lacks; null if there is none.
const char* feature_beyond(const DeviceProperties& told, const DeviceProperties& supported);

// Queries the driver. Functions of the instance level must be loaded.
DeviceProperties query_device_properties(const VulkanTable& vk, VkPhysicalDevice device);
std::vector<VkPhysicalDevice> physical_devices(const VulkanTable& vk, VkInstance instance);
std::vector<VkExtensionProperties> device_extensions(const VulkanTable& vk, VkPhysicalDevice device);

// Returns the first queue family with compute; -1 if there is none.
int compute_queue_family(const VulkanTable& vk, VkPhysicalDevice device);

}  // namespace twinray
