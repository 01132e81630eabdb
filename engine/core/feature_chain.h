// SPDX-License-Identifier: MIT
// The features of a device that twinray knows, in the chains of structs in which Vulkan reports and enables them.
#pragma once

#include <cstddef>
#include <span>

#include <twinray/context.h>

namespace twinray {

// One struct for each feature. Unlike those of a whole Vulkan version they may stand in any chain that does not hold
// the feature already.
struct FeatureStructs {
    VkPhysicalDeviceFeatures2 core{};
    VkPhysicalDeviceTimelineSemaphoreFeatures timeline{};
    VkPhysicalDeviceBufferDeviceAddressFeatures address{};
    VkPhysicalDeviceScalarBlockLayoutFeatures layout{};
    VkPhysicalDeviceDescriptorIndexingFeatures indexing{};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{};
    VkPhysicalDeviceRayQueryFeaturesKHR query{};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{};
    VkPhysicalDeviceFaultFeaturesEXT fault{};

    FeatureStructs();  // all features off
    // The struct of a type; null if none of these.
    VkBaseOutStructure* find(VkStructureType type);
};

struct FeatureBit {
    bool DeviceProperties::*fact;
    const char* name;
    VkStructureType own;  // which of FeatureStructs, and where in it
    std::size_t own_offset;
    VkStructureType gathered;  // the struct of the Vulkan version that took the feature in; `own` where none has
    std::size_t gathered_offset;
};
std::span<const FeatureBit> feature_bits();

// The bit of a feature in whichever struct of a chain holds it; null if none does.
VkBool32* find_bit(VkBaseOutStructure* chain, const FeatureBit& bit);

// The same in a device's info. Where its chain does not hold the feature, a struct of `ours` is put before the chain.
VkBool32& provide_bit(VkDeviceCreateInfo& info, FeatureStructs& ours, const FeatureBit& bit);

// Which features and extensions a device has that was created with `info`; the other properties stay.
void state_features(const VkDeviceCreateInfo& info, DeviceProperties& properties);

// The first feature that `told` has and `supported` lacks; null if there is none.
const char* feature_beyond(const DeviceProperties& told, const DeviceProperties& supported);

}  // namespace twinray
