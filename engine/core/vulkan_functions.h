// SPDX-License-Identifier: MIT
// Every Vulkan function that twinray calls, by level. The library defines no global vk* symbol: these names become
// members of one table per device, so that a host may link the Vulkan loader, volk or another copy beside it.
#pragma once

#include <vulkan/vulkan_core.h>

#include <span>

#define TWINRAY_GLOBAL_FUNCTIONS(F)           \
    F(vkCreateInstance)                       \
    F(vkEnumerateInstanceExtensionProperties) \
    F(vkEnumerateInstanceLayerProperties)

#define TWINRAY_INSTANCE_FUNCTIONS(F)           \
    F(vkDestroyInstance)                        \
    F(vkEnumeratePhysicalDevices)               \
    F(vkEnumerateDeviceExtensionProperties)     \
    F(vkGetPhysicalDeviceProperties2)           \
    F(vkGetPhysicalDeviceFeatures2)             \
    F(vkGetPhysicalDeviceQueueFamilyProperties) \
    F(vkGetPhysicalDeviceMemoryProperties)      \
    F(vkGetPhysicalDeviceFormatProperties)      \
    F(vkCreateDevice)                           \
    F(vkGetDeviceProcAddr)

// Present only with VK_EXT_debug_utils.
#define TWINRAY_DEBUG_FUNCTIONS(F)     \
    F(vkCreateDebugUtilsMessengerEXT)  \
    F(vkDestroyDebugUtilsMessengerEXT) \
    F(vkSetDebugUtilsObjectNameEXT)    \
    F(vkCmdBeginDebugUtilsLabelEXT)    \
    F(vkCmdEndDebugUtilsLabelEXT)

#define TWINRAY_DEVICE_FUNCTIONS(F)  \
    F(vkDestroyDevice)               \
    F(vkGetDeviceQueue)              \
    F(vkQueueSubmit)                 \
    F(vkCreateCommandPool)           \
    F(vkDestroyCommandPool)          \
    F(vkAllocateCommandBuffers)      \
    F(vkBeginCommandBuffer)          \
    F(vkEndCommandBuffer)            \
    F(vkCreateSemaphore)             \
    F(vkDestroySemaphore)            \
    F(vkWaitSemaphores)              \
    F(vkGetSemaphoreCounterValue)    \
    F(vkCreateQueryPool)             \
    F(vkDestroyQueryPool)            \
    F(vkGetQueryPoolResults)         \
    F(vkCmdResetQueryPool)           \
    F(vkCmdCopyQueryPoolResults)     \
    F(vkCmdWriteTimestamp)           \
    F(vkCreateShaderModule)          \
    F(vkDestroyShaderModule)         \
    F(vkCreatePipelineCache)         \
    F(vkGetPipelineCacheData)        \
    F(vkDestroyPipelineCache)        \
    F(vkCreatePipelineLayout)        \
    F(vkDestroyPipelineLayout)       \
    F(vkCreateComputePipelines)      \
    F(vkDestroyPipeline)             \
    F(vkCmdBindPipeline)             \
    F(vkCmdPushConstants)            \
    F(vkCmdDispatch)                 \
    F(vkCmdDispatchIndirect)         \
    F(vkCmdPipelineBarrier)          \
    F(vkCmdCopyBuffer)               \
    F(vkCmdFillBuffer)               \
    F(vkCmdUpdateBuffer)             \
    F(vkGetBufferDeviceAddress)      \
    F(vkCreateBuffer)                \
    F(vkDestroyBuffer)               \
    F(vkGetBufferMemoryRequirements) \
    F(vkAllocateMemory)              \
    F(vkFreeMemory)                  \
    F(vkBindBufferMemory)            \
    F(vkCreateImageView)             \
    F(vkDestroyImageView)            \
    F(vkCreateSampler)               \
    F(vkDestroySampler)              \
    F(vkCreateDescriptorSetLayout)   \
    F(vkDestroyDescriptorSetLayout)  \
    F(vkCreateDescriptorPool)        \
    F(vkDestroyDescriptorPool)       \
    F(vkAllocateDescriptorSets)      \
    F(vkUpdateDescriptorSets)        \
    F(vkCmdBindDescriptorSets)       \
    F(vkCmdCopyBufferToImage)

// Present only with VK_KHR_pipeline_executable_properties.
#define TWINRAY_STATISTICS_FUNCTIONS(F)     \
    F(vkGetPipelineExecutablePropertiesKHR) \
    F(vkGetPipelineExecutableStatisticsKHR)

// Present only with VK_KHR_external_memory_fd.
#define TWINRAY_EXTERNAL_FUNCTIONS(F) F(vkGetMemoryFdKHR)

// Present only with VK_EXT_device_fault.
#define TWINRAY_FAULT_FUNCTIONS(F) F(vkGetDeviceFaultInfoEXT)

// Present only with VK_KHR_acceleration_structure and VK_KHR_ray_tracing_pipeline.
#define TWINRAY_RAY_TRACING_FUNCTIONS(F)                \
    F(vkCreateAccelerationStructureKHR)                 \
    F(vkDestroyAccelerationStructureKHR)                \
    F(vkGetAccelerationStructureBuildSizesKHR)          \
    F(vkGetAccelerationStructureDeviceAddressKHR)       \
    F(vkCmdBuildAccelerationStructuresKHR)              \
    F(vkCmdWriteAccelerationStructuresPropertiesKHR)    \
    F(vkCmdCopyAccelerationStructureKHR)                \
    F(vkCmdCopyAccelerationStructureToMemoryKHR)        \
    F(vkCmdCopyMemoryToAccelerationStructureKHR)        \
    F(vkGetDeviceAccelerationStructureCompatibilityKHR) \
    F(vkCreateRayTracingPipelinesKHR)                   \
    F(vkGetRayTracingShaderGroupHandlesKHR)             \
    F(vkCmdTraceRaysKHR)

namespace twinray {

// Filled from one vkGetInstanceProcAddr; a function of an extension that is not enabled stays null.
struct VulkanFunctions {
    PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr = nullptr;
#define TWINRAY_MEMBER(name) PFN_##name name = nullptr;
    TWINRAY_GLOBAL_FUNCTIONS(TWINRAY_MEMBER)
    TWINRAY_INSTANCE_FUNCTIONS(TWINRAY_MEMBER)
    TWINRAY_DEBUG_FUNCTIONS(TWINRAY_MEMBER)
    TWINRAY_DEVICE_FUNCTIONS(TWINRAY_MEMBER)
    TWINRAY_STATISTICS_FUNCTIONS(TWINRAY_MEMBER)
    TWINRAY_EXTERNAL_FUNCTIONS(TWINRAY_MEMBER)
    TWINRAY_FAULT_FUNCTIONS(TWINRAY_MEMBER)
    TWINRAY_RAY_TRACING_FUNCTIONS(TWINRAY_MEMBER)
#undef TWINRAY_MEMBER

    // get_instance_proc_addr null: opens the system's Vulkan loader. Throws Error if there is none.
    void load_global(PFN_vkGetInstanceProcAddr get_instance_proc_addr);
    // Without debug labels where an installed validation layer would crash by them: see labels_are_safe.
    void load_instance(VkInstance instance);
    void load_device(VkDevice device);
};

// False where one of the layers is the Khronos validation layer of before 1.3.243. It forgets the labels of a destroyed
// command buffer on a thread of its own without its lock, by the handle, which a new command buffer may have by then:
// the heap is corrupted, seldom (issue 5172 of Vulkan-ValidationLayers).
bool labels_are_safe(std::span<const VkLayerProperties> layers);

// Throws Error naming the action and the VkResult unless result is VK_SUCCESS.
void vk_check(VkResult result, const char* action);
const char* name_of(VkResult result);

}  // namespace twinray
