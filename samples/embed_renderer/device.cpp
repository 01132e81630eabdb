// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/device.h"

#include <vk_mem_alloc.h>

#include <twinray/vma_adapter.h>
#include "samples/support/text.h"

namespace twinray::embed_renderer {
using samples::fail;
namespace {

constexpr std::uint32_t api_version = VK_API_VERSION_1_2;

// Rasterises and computes; -1 if there is none.
int universal_family(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & wanted) == wanted && families[i].timestampValidBits) return static_cast<int>(i);
    return -1;
}

template <class Function>
Function instance_function(VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

}  // namespace

void require(VkResult result, const char* action) {
    if (result != VK_SUCCESS) fail(action, ": VkResult ", static_cast<int>(result));
}

Device::Device(const DeviceDesc& desc) : log_(desc.log) {
    try {
        create_instance(desc.validation);
        choose(desc.device);
        create_device(desc);
        create_allocator();
    } catch (...) {
        destroy();
        throw;
    }
}

Device::~Device() { destroy(); }

void Device::destroy() {
    if (allocator_) vmaDestroyAllocator(allocator_);
    if (device_) vkDestroyDevice(device_, nullptr);
    if (messenger_)
        instance_function<PFN_vkDestroyDebugUtilsMessengerEXT>(instance_, "vkDestroyDebugUtilsMessengerEXT")(
            instance_, messenger_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

VkBool32 VKAPI_PTR Device::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                      const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& device = *static_cast<Device*>(user);
    ++device.message_count_;
    if (device.log_) device.log_(data->pMessage);
    return VK_FALSE;
}

void Device::create_instance(bool validation) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "embed_renderer";
    application.apiVersion = api_version;
    const VkValidationFeatureEnableEXT synchronisation = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronisation;
    const char* layer = "VK_LAYER_KHRONOS_validation";
    const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pNext = validation ? &features : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = validation ? 1 : 0;
    info.ppEnabledLayerNames = &layer;
    info.enabledExtensionCount = validation ? 2 : 0;
    info.ppEnabledExtensionNames = extensions;
    require(vkCreateInstance(&info, nullptr, &instance_), "create an instance");
    if (!validation) return;
    VkDebugUtilsMessengerCreateInfoEXT listen{};
    listen.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    listen.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    listen.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    listen.pfnUserCallback = on_message;
    listen.pUserData = this;
    const auto create =
        instance_function<PFN_vkCreateDebugUtilsMessengerEXT>(instance_, "vkCreateDebugUtilsMessengerEXT");
    require(create(instance_, &listen, nullptr, &messenger_), "create a debug messenger");
}

// The best of those that can also rasterise.
void Device::choose(const std::string& request) {
    std::uint32_t count = 0;
    require(vkEnumeratePhysicalDevices(instance_, &count, nullptr), "list the devices");
    std::vector<VkPhysicalDevice> devices(count);
    require(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "list the devices");
    std::vector<DeviceProperties> properties;
    for (VkPhysicalDevice device : devices) {
        properties.push_back(query_device_properties(vkGetInstanceProcAddr, instance_, device));
        properties.back().has_compute_queue = universal_family(device) >= 0;
    }
    const DeviceChoice choice = choose_device(properties, request);
    if (choice.index < 0) {
        std::string reasons;
        for (const std::string& reason : choice.rejections) reasons += "\n  " + reason;
        fail("no device that matches '", request, "' rasterises and runs twinray:", reasons);
    }
    physical_ = devices[static_cast<std::size_t>(choice.index)];
    queue_family_ = static_cast<std::uint32_t>(universal_family(physical_));
    VkPhysicalDeviceProperties chosen;
    vkGetPhysicalDeviceProperties(physical_, &chosen);
    timestamp_period_ns_ = static_cast<double>(chosen.limits.timestampPeriod);
}

// The renderer asks for what it wants, twinray adds what it needs.
void Device::create_device(const DeviceDesc& desc) {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan12Features own{};
    own.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    own.hostQueryReset = VK_TRUE;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &own;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    DeviceProperties wanted = query_device_properties(vkGetInstanceProcAddr, instance_, physical_);
    wanted.ray_query &= desc.use_ray_query;
    wanted.ray_tracing_pipeline &= desc.use_ray_tracing_pipeline;
    DeviceRequirements requirements(wanted);
    requirements.add_to(info);
    require(vkCreateDevice(physical_, &info, nullptr, &device_), "create a device");
    enabled_ = enabled_properties(vkGetInstanceProcAddr, instance_, physical_, info);
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
}

void Device::create_allocator() {
    VmaVulkanFunctions functions{};
    functions.vkGetInstanceProcAddr = vkGetInstanceProcAddr;
    functions.vkGetDeviceProcAddr = vkGetDeviceProcAddr;
    VmaAllocatorCreateInfo info{};
    info.flags = VMA_ALLOCATOR_CREATE_BUFFER_DEVICE_ADDRESS_BIT;
    info.instance = instance_;
    info.physicalDevice = physical_;
    info.device = device_;
    info.vulkanApiVersion = api_version;
    info.pVulkanFunctions = &functions;
    require(vmaCreateAllocator(&info, &allocator_), "create the allocator");
}

// [adopted]
AdoptedDevice Device::adopted() const {
    AdoptedDevice adopted;
    adopted.instance = instance_;
    adopted.physical_device = physical_;
    adopted.device = device_;
    adopted.queue = queue_;
    adopted.queue_family = queue_family_;
    adopted.get_instance_proc_addr = vkGetInstanceProcAddr;
    adopted.api_version = api_version;
    adopted.enabled = enabled_;
    adopted.allocator = hooks_of(allocator_);
    adopted.log = log_;
    return adopted;
}
// [/adopted]

void Device::run_once(const std::function<void(VkCommandBuffer)>& record) const {
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.queueFamilyIndex = queue_family_;
    VkCommandPool pool = VK_NULL_HANDLE;
    require(vkCreateCommandPool(device_, &pool_info, nullptr, &pool), "create a command pool");
    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    require(vkAllocateCommandBuffers(device_, &allocate, &commands), "allocate a command buffer");
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    require(vkBeginCommandBuffer(commands, &begin), "begin a command buffer");
    record(commands);
    require(vkEndCommandBuffer(commands), "end a command buffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    require(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "submit");
    require(vkQueueWaitIdle(queue_), "wait for the queue");
    vkDestroyCommandPool(device_, pool, nullptr);
}

std::uint32_t Device::live_allocations() const {
    VmaTotalStatistics statistics;
    vmaCalculateStatistics(allocator_, &statistics);
    return statistics.total.statistics.allocationCount;
}

}  // namespace twinray::embed_renderer
