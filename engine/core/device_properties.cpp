#include "engine/core/device_properties.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/core/requirement.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

constexpr VkStructureType type_of_core = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
constexpr VkStructureType type_of_vulkan12 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
constexpr VkStructureType type_of_timeline = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
constexpr VkStructureType type_of_address = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES;
constexpr VkStructureType type_of_layout = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES;
constexpr VkStructureType type_of_indexing = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_FEATURES;
constexpr VkStructureType type_of_structure = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
constexpr VkStructureType type_of_query = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
constexpr VkStructureType type_of_tracing = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR;
constexpr VkStructureType type_of_fault = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FAULT_FEATURES_EXT;

constexpr FeatureBit alone(bool DeviceProperties::*fact, const char* name, VkStructureType type, std::size_t offset) {
    return {fact, name, type, offset, type, offset};
}

constexpr FeatureBit bits[] = {
    alone(&DeviceProperties::shader_int64, "shaderInt64", type_of_core,
          offsetof(VkPhysicalDeviceFeatures2, features.shaderInt64)),
    alone(&DeviceProperties::shader_float64, "shaderFloat64", type_of_core,
          offsetof(VkPhysicalDeviceFeatures2, features.shaderFloat64)),
    {&DeviceProperties::timeline_semaphore, "timelineSemaphore", type_of_timeline,
     offsetof(VkPhysicalDeviceTimelineSemaphoreFeatures, timelineSemaphore), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, timelineSemaphore)},
    {&DeviceProperties::buffer_device_address, "bufferDeviceAddress", type_of_address,
     offsetof(VkPhysicalDeviceBufferDeviceAddressFeatures, bufferDeviceAddress), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, bufferDeviceAddress)},
    {&DeviceProperties::scalar_block_layout, "scalarBlockLayout", type_of_layout,
     offsetof(VkPhysicalDeviceScalarBlockLayoutFeatures, scalarBlockLayout), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, scalarBlockLayout)},
    {&DeviceProperties::runtime_descriptor_array, "runtimeDescriptorArray", type_of_indexing,
     offsetof(VkPhysicalDeviceDescriptorIndexingFeatures, runtimeDescriptorArray), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, runtimeDescriptorArray)},
    {&DeviceProperties::variable_descriptor_count, "descriptorBindingVariableDescriptorCount", type_of_indexing,
     offsetof(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingVariableDescriptorCount), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, descriptorBindingVariableDescriptorCount)},
    {&DeviceProperties::nonuniform_sampled_images, "shaderSampledImageArrayNonUniformIndexing", type_of_indexing,
     offsetof(VkPhysicalDeviceDescriptorIndexingFeatures, shaderSampledImageArrayNonUniformIndexing), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, shaderSampledImageArrayNonUniformIndexing)},
    {&DeviceProperties::update_after_bind_images, "descriptorBindingSampledImageUpdateAfterBind", type_of_indexing,
     offsetof(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingSampledImageUpdateAfterBind),
     type_of_vulkan12, offsetof(VkPhysicalDeviceVulkan12Features, descriptorBindingSampledImageUpdateAfterBind)},
    alone(&DeviceProperties::acceleration_structure, "accelerationStructure", type_of_structure,
          offsetof(VkPhysicalDeviceAccelerationStructureFeaturesKHR, accelerationStructure)),
    alone(&DeviceProperties::ray_query, "rayQuery", type_of_query,
          offsetof(VkPhysicalDeviceRayQueryFeaturesKHR, rayQuery)),
    alone(&DeviceProperties::ray_tracing_pipeline, "rayTracingPipeline", type_of_tracing,
          offsetof(VkPhysicalDeviceRayTracingPipelineFeaturesKHR, rayTracingPipeline)),
    alone(&DeviceProperties::primitive_culling, "rayTraversalPrimitiveCulling", type_of_tracing,
          offsetof(VkPhysicalDeviceRayTracingPipelineFeaturesKHR, rayTraversalPrimitiveCulling)),
    alone(&DeviceProperties::device_fault, "deviceFault", type_of_fault,
          offsetof(VkPhysicalDeviceFaultFeaturesEXT, deviceFault)),
};

// One struct for each feature. Unlike those of a whole Vulkan version they may be in any chain that does not hold the
// feature already.
struct FeatureStructs {  // all features off
    VkPhysicalDeviceFeatures2 core = OfType{type_of_core};
    VkPhysicalDeviceTimelineSemaphoreFeatures timeline = OfType{type_of_timeline};
    VkPhysicalDeviceBufferDeviceAddressFeatures address = OfType{type_of_address};
    VkPhysicalDeviceScalarBlockLayoutFeatures layout = OfType{type_of_layout};
    VkPhysicalDeviceDescriptorIndexingFeatures indexing = OfType{type_of_indexing};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structure = OfType{type_of_structure};
    VkPhysicalDeviceRayQueryFeaturesKHR query = OfType{type_of_query};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline = OfType{type_of_tracing};
    VkPhysicalDeviceFaultFeaturesEXT fault = OfType{type_of_fault};

    // Returns the struct of a type; null if it is not one of these.
    VkBaseOutStructure* find(VkStructureType type) {
        void* all[] = {&core, &timeline, &address, &layout, &indexing, &structure, &query, &pipeline, &fault};
        for (void* node : all)
            if (auto* base = static_cast<VkBaseOutStructure*>(node); base->sType == type) return base;
        return nullptr;
    }
};

VkBool32* bit_at(VkBaseOutStructure* node, std::size_t offset) {
    return reinterpret_cast<VkBool32*>(reinterpret_cast<std::byte*>(node) + offset);
}

bool has_extension(const VkDeviceCreateInfo& info, const char* name) {
    return std::ranges::any_of(std::span(info.ppEnabledExtensionNames, info.enabledExtensionCount),
                               [&](const char* extension) { return std::strcmp(extension, name) == 0; });
}

// Returns the bit of a feature in a device's info. If its chain does not hold the feature, a struct of `ours` is put
// before the chain.
VkBool32& provide_bit(VkDeviceCreateInfo& info, FeatureStructs& ours, const FeatureBit& bit) {
    auto* chain = static_cast<VkBaseOutStructure*>(const_cast<void*>(info.pNext));
    if (VkBool32* found = find_bit(chain, bit)) return *found;
    VkBaseOutStructure* added = ours.find(bit.own);
    if (bit.own == type_of_core && info.pEnabledFeatures) {
        // Vulkan does not allow both.
        ours.core.features = *info.pEnabledFeatures;
        info.pEnabledFeatures = nullptr;
    }
    added->pNext = chain;
    info.pNext = added;
    return *find_bit(added, bit);
}

DeviceKind kind_of(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return DeviceKind::discrete;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return DeviceKind::integrated;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return DeviceKind::virtual_gpu;
        case VK_PHYSICAL_DEVICE_TYPE_CPU: return DeviceKind::cpu;
        default: return DeviceKind::other;
    }
}

// Reads the features as if a device were created with everything that this one has.
void query_features(const VulkanTable& vk, VkPhysicalDevice device, DeviceProperties& properties) {
    const std::vector<VkExtensionProperties> extensions = device_extensions(vk, device);
    std::vector<const char*> names;
    for (const VkExtensionProperties& extension : extensions) names.push_back(extension.extensionName);
    FeatureStructs structs;
    VkDeviceCreateInfo everything{};
    for (const FeatureBit& bit : feature_bits())
        if (bit.own != structs.core.sType) provide_bit(everything, structs, bit);
    structs.core.pNext = const_cast<void*>(everything.pNext);
    everything.pNext = &structs.core;
    vk.vkGetPhysicalDeviceFeatures2(device, &structs.core);
    everything.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
    everything.ppEnabledExtensionNames = names.data();
    state_features(everything, properties);
}

VulkanTable instance_functions(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance) {
    VulkanTable vk;
    vk.load_global(get_instance_proc_addr);
    vk.load_instance(instance);
    if (!vk.vkGetPhysicalDeviceFeatures2)
        fail("properties of a device: its VkInstance was created for less than Vulkan 1.1; twinray needs 1.2");
    return vk;
}

}  // namespace

std::span<const FeatureBit> feature_bits() { return bits; }

VkBool32* find_bit(VkBaseOutStructure* chain, const FeatureBit& bit) {
    for (; chain; chain = chain->pNext) {
        if (chain->sType == bit.own) return bit_at(chain, bit.own_offset);
        if (chain->sType == bit.gathered) return bit_at(chain, bit.gathered_offset);
    }
    return nullptr;
}

void state_features(const VkDeviceCreateInfo& info, DeviceProperties& properties) {
    auto* chain = static_cast<VkBaseOutStructure*>(const_cast<void*>(info.pNext));
    VkPhysicalDeviceFeatures2 old_style = OfType{type_of_core};
    if (info.pEnabledFeatures) old_style.features = *info.pEnabledFeatures;
    for (const FeatureBit& bit : bits) {
        const VkBool32* found = find_bit(chain, bit);
        if (!found && bit.own == type_of_core)
            found = bit_at(reinterpret_cast<VkBaseOutStructure*>(&old_style), bit.own_offset);
        properties.*bit.fact = found && *found;
    }
    properties.acceleration_structure &= has_extension(info, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME) &&
                                         has_extension(info, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME);
    properties.ray_query &= properties.acceleration_structure && has_extension(info, VK_KHR_RAY_QUERY_EXTENSION_NAME);
    properties.ray_tracing_pipeline &=
        properties.acceleration_structure && has_extension(info, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
    properties.primitive_culling &= properties.ray_tracing_pipeline;
    properties.device_fault &= has_extension(info, VK_EXT_DEVICE_FAULT_EXTENSION_NAME);
    properties.external_memory = has_extension(info, platform::shared_memory.extension);
}

const char* feature_beyond(const DeviceProperties& told, const DeviceProperties& supported) {
    for (const FeatureBit& bit : bits)
        if (told.*bit.fact && !(supported.*bit.fact)) return bit.name;
    return nullptr;
}

std::vector<VkPhysicalDevice> physical_devices(const VulkanTable& vk, VkInstance instance) {
    return listed<VkPhysicalDevice>([&](std::uint32_t* count, VkPhysicalDevice* devices) {
        vk_check(vk.vkEnumeratePhysicalDevices(instance, count, devices), "list Vulkan devices");
    });
}

std::vector<VkExtensionProperties> device_extensions(const VulkanTable& vk, VkPhysicalDevice device) {
    return listed<VkExtensionProperties>([&](std::uint32_t* count, VkExtensionProperties* extensions) {
        vk_check(vk.vkEnumerateDeviceExtensionProperties(device, nullptr, count, extensions), "list device extensions");
    });
}

std::vector<VkQueueFamilyProperties> queue_families(const VulkanTable& vk, VkPhysicalDevice device) {
    return listed<VkQueueFamilyProperties>([&](std::uint32_t* count, VkQueueFamilyProperties* families) {
        vk.vkGetPhysicalDeviceQueueFamilyProperties(device, count, families);
    });
}

int compute_queue_family(const VulkanTable& vk, VkPhysicalDevice device) {
    const std::vector<VkQueueFamilyProperties> families = queue_families(vk, device);
    for (std::size_t i = 0; i < families.size(); ++i)
        if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) return static_cast<int>(i);
    return -1;
}

DeviceProperties query_device_properties(const VulkanTable& vk, VkPhysicalDevice device) {
    VkPhysicalDeviceDriverProperties driver = OfType{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceSubgroupProperties subgroup = OfType{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    subgroup.pNext = &driver;
    VkPhysicalDeviceIDProperties id = OfType{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES};
    id.pNext = &subgroup;
    VkPhysicalDeviceProperties2 reported = OfType{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    reported.pNext = &id;
    vk.vkGetPhysicalDeviceProperties2(device, &reported);

    DeviceProperties properties;
    properties.name = reported.properties.deviceName;
    properties.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    properties.kind = kind_of(reported.properties.deviceType);
    properties.driver_id = driver.driverID;
    std::copy(std::begin(id.deviceUUID), std::end(id.deviceUUID), properties.uuid.begin());
    if (properties.kind == DeviceKind::cpu) properties.cpu_threads = count_cpu_threads();
    properties.subgroup_size = subgroup.subgroupSize;
    properties.api_version = reported.properties.apiVersion;
    const VkPhysicalDeviceLimits& limits = reported.properties.limits;
    properties.shared_bytes = limits.maxComputeSharedMemorySize;
    properties.group_invocations = std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
    properties.push_constant_bytes = limits.maxPushConstantsSize;
    properties.has_compute_queue = compute_queue_family(vk, device) >= 0;
    if (properties.api_version >= VK_API_VERSION_1_2) query_features(vk, device, properties);
    return properties;
}

DeviceProperties query_device_properties(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                         VkPhysicalDevice device) {
    return query_device_properties(instance_functions(get_instance_proc_addr, instance), device);
}

DeviceProperties enabled_properties(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                    VkPhysicalDevice device, const VkDeviceCreateInfo& info) {
    DeviceProperties properties = query_device_properties(get_instance_proc_addr, instance, device);
    state_features(info, properties);
    return properties;
}

struct DeviceRequirements::State {
    explicit State(const DeviceProperties& device) : supported(device) {
        supported.primitive_culling &= device.ray_tracing_pipeline;  // a feature of that extension
    }
    void switch_on(VkDeviceCreateInfo& info, FeatureStructs& structs) const {
        for (const FeatureBit& bit : feature_bits())
            if (supported.*bit.fact) provide_bit(info, structs, bit) = VK_TRUE;
    }

    DeviceProperties supported;
    std::vector<const char*> extensions, all_extensions;
    VkDeviceCreateInfo alone{};
    FeatureStructs alone_structs, added_structs;
};

DeviceRequirements::DeviceRequirements(const DeviceProperties& supported) : state_(new State(supported)) {
    std::vector<const char*>& extensions = state_->extensions;
    if (supported.acceleration_structure)
        extensions = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
    if (supported.ray_query) extensions.push_back(VK_KHR_RAY_QUERY_EXTENSION_NAME);
    if (supported.ray_tracing_pipeline) extensions.push_back(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
    if (supported.device_fault) extensions.push_back(VK_EXT_DEVICE_FAULT_EXTENSION_NAME);
    if (supported.external_memory) extensions.push_back(platform::shared_memory.extension);
    state_->switch_on(state_->alone, state_->alone_structs);
}

DeviceRequirements::~DeviceRequirements() = default;
const DeviceProperties& DeviceRequirements::supported() const { return state_->supported; }
const std::vector<const char*>& DeviceRequirements::extensions() const { return state_->extensions; }
const void* DeviceRequirements::features() const { return state_->alone.pNext; }

std::vector<std::string> DeviceRequirements::sentences() const {
    std::vector<std::string> sentences;
    for (const Requirement& requirement : requirements_of(state_->supported))
        sentences.push_back(requirement.sentence());
    return sentences;
}

void DeviceRequirements::add_to(VkDeviceCreateInfo& info) {
    const std::span host(info.ppEnabledExtensionNames, info.enabledExtensionCount);
    state_->all_extensions.assign(host.begin(), host.end());
    for (const char* ours : state_->extensions)
        if (!has_extension(info, ours)) state_->all_extensions.push_back(ours);
    info.enabledExtensionCount = static_cast<std::uint32_t>(state_->all_extensions.size());
    info.ppEnabledExtensionNames = state_->all_extensions.data();
    state_->switch_on(info, state_->added_structs);
}

unsigned count_cpu_threads() {
    const char* text = std::getenv("LP_NUM_THREADS");
    const long wanted = text ? std::strtol(text, nullptr, 10) : 0;
    if (wanted > 0) return static_cast<unsigned>(std::min(wanted, 1024L));
    return std::max(1u, std::thread::hardware_concurrency());
}

bool has_512_bit_vectors() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

int lavapipe_release(const DeviceProperties& device) {
    constexpr std::string_view mesa = "Mesa ";
    const std::size_t at = device.driver.find(mesa);
    if (!device.name.starts_with("llvmpipe") || at == std::string::npos) return 0;
    return std::atoi(device.driver.c_str() + at + mesa.size());
}

bool takes_any_vector_width(const DeviceProperties& device) {
    constexpr int first_of_one_width = 26;
    const int release = lavapipe_release(device);
    return release != 0 && release < first_of_one_width;
}

}  // namespace twinray
