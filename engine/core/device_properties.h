// Queries a Vulkan device's properties from its driver, and lists the features to enable when one is created. Facts
// about Mesa's CPU driver, and about the CPU that it runs on.
#pragma once

#include <cstddef>

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

std::vector<VkQueueFamilyProperties> queue_families(const VulkanTable& vk, VkPhysicalDevice device);

// Returns the first queue family with compute; -1 if there is none.
int compute_queue_family(const VulkanTable& vk, VkPhysicalDevice device);

// Returns the number of threads on which a CPU driver runs groups: LP_NUM_THREADS (of Mesa) if that is a number above
// 0, else one per core.
unsigned count_cpu_threads();

// Returns whether this is a CPU with AVX-512 (F, BW, DQ, VL) that the system lets programs use.
bool has_512_bit_vectors();

// Returns the release of Mesa if the device's driver is lavapipe: 25, 26; else 0.
int lavapipe_release(const DeviceProperties& device);

// Returns whether the driver of a CPU computes with vectors of any width (LP_NATIVE_VECTOR_WIDTH): Mesa's did below 26.
// In 26 and later, its own builds of acceleration structures crash at widths other than the one that it chooses.
bool takes_any_vector_width(const DeviceProperties& device);

}  // namespace twinray
