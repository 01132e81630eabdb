// A host that made its own instance and device through volk: both live in one program, because the library defines no
// vk* symbol of its own.
#pragma once

#include <gtest/gtest.h>

#define VK_NO_PROTOTYPES
#include <volk.h>

#include "tests/support/device.h"

namespace twinray::test {

// A device as a renderer owns it, created with the requirements that twinray publishes.
struct Host {
    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    AdoptedDevice device;
    int locked = 0, submissions = 0;

    DeviceProperties supported;
    bool wants_hardware = true;  // false: without the ray tracing extensions
    bool wants_float64 = true;
    std::function<void(VkDeviceCreateInfo&)> extend = {};  // adds what the host wants for itself

    Host() = default;
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;
    bool create();
    ~Host() {
        if (device.device) vkDestroyDevice(device.device, nullptr);
        if (messenger) vkDestroyDebugUtilsMessengerEXT(instance, messenger, nullptr);
        if (instance) vkDestroyInstance(instance, nullptr);
    }

  private:
    bool create_instance();
    bool create_device(VkPhysicalDevice physical, DeviceRequirements& requirements);
};

inline VkBool32 VKAPI_PTR fail_test(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
    ADD_FAILURE() << data->pMessage;
    return VK_FALSE;
}

// Uses the validation layer, synchronisation included: any message fails the test.
inline bool Host::create_instance() {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_2;
    const VkValidationFeatureEnableEXT synchronisation = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronisation;
    const char* layer = "VK_LAYER_KHRONOS_validation";
    const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (::twinray::test::has_validation()) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = extensions;
    }
    if (vkCreateInstance(&info, nullptr, &instance) != VK_SUCCESS) return false;
    volkLoadInstance(instance);
    if (!::twinray::test::has_validation()) return true;
    VkDebugUtilsMessengerCreateInfoEXT listen{};
    listen.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    listen.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    listen.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    listen.pfnUserCallback = fail_test;
    return vkCreateDebugUtilsMessengerEXT(instance, &listen, nullptr, &messenger) == VK_SUCCESS;
}

inline bool Host::create() {
    if (volkInitialize() != VK_SUCCESS || !create_instance()) return false;
    uint32_t count = 1;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    vkEnumeratePhysicalDevices(instance, &count, &physical);
    if (count == 0) return false;
    supported = query_device_properties(vkGetInstanceProcAddr, instance, physical);
    DeviceProperties wanted = supported;
    if (!wants_hardware) wanted.acceleration_structure = wanted.ray_query = wanted.ray_tracing_pipeline = false;
    wanted.shader_float64 &= wants_float64;
    DeviceRequirements requirements(wanted);
    if (!create_device(physical, requirements)) return false;
    volkLoadDevice(device.device);
    vkGetDeviceQueue(device.device, device.queue_family, 0, &device.queue);
    device.instance = instance;
    device.physical_device = physical;
    device.get_instance_proc_addr = vkGetInstanceProcAddr;
    device.api_version = VK_API_VERSION_1_2;
    device.lock_queue = [this] { ++locked; };
    device.unlock_queue = [this] {
        --locked;
        ++submissions;
    };
    return true;
}

// Family 0 has compute on every driver known; check_adoption would say otherwise.
inline bool Host::create_device(VkPhysicalDevice physical, DeviceRequirements& requirements) {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    if (extend) extend(info);
    requirements.add_to(info);
    if (vkCreateDevice(physical, &info, nullptr, &device.device) != VK_SUCCESS) return false;
    device.enabled = enabled_properties(vkGetInstanceProcAddr, instance, physical, info);
    return true;
}

// The fixture for label `vulkan`.
class HostTest : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!make_context()) TWINRAY_LACKS("vulkan", "no usable device");
    }
    Host host_;
};

}  // namespace twinray::test
