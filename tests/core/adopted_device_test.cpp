// SPDX-License-Identifier: MIT
// A host that made its own instance and device through volk: both live in one program, because the library defines no
// vk* symbol of its own.
#include <gtest/gtest.h>

#include <cmath>

#define VK_NO_PROTOTYPES
#include <volk.h>

#include "engine/core/error.h"
#include "engine/scene/shapes.h"
#include "hwtlas/hw_tlas.h"
#include "swtlas/sw_tlas.h"
#include "tests/support/device.h"

namespace twinray {
namespace {

// What a renderer would own: created with the requirements that twinray publishes.
struct Host {
    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    AdoptedDevice device;
    int locked = 0, submissions = 0;

    bool create();
    bool create_instance();
    ~Host() {
        if (device.device) vkDestroyDevice(device.device, nullptr);
        if (messenger) vkDestroyDebugUtilsMessengerEXT(instance, messenger, nullptr);
        if (instance) vkDestroyInstance(instance, nullptr);
    }
};

VkBool32 VKAPI_PTR fail_test(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                             const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
    ADD_FAILURE() << data->pMessage;
    return VK_FALSE;
}

// With the validation layer, synchronisation included: any message fails the test.
bool Host::create_instance() {
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
    info.pNext = &features;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &layer;
    info.enabledExtensionCount = 2;
    info.ppEnabledExtensionNames = extensions;
    if (vkCreateInstance(&info, nullptr, &instance) != VK_SUCCESS) return false;
    volkLoadInstance(instance);
    VkDebugUtilsMessengerCreateInfoEXT listen{};
    listen.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    listen.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    listen.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    listen.pfnUserCallback = fail_test;
    return vkCreateDebugUtilsMessengerEXT(instance, &listen, nullptr, &messenger) == VK_SUCCESS;
}

bool Host::create() {
    if (volkInitialize() != VK_SUCCESS) return false;
    if (!create_instance()) return false;
    uint32_t count = 1;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    vkEnumeratePhysicalDevices(instance, &count, &physical);
    if (count == 0) return false;

    VulkanFunctions functions;
    functions.load_global(vkGetInstanceProcAddr);
    functions.load_instance(instance);
    device.enabled = query_device_facts(functions, physical);
    const DeviceRequirements requirements(device.enabled);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = static_cast<uint32_t>(compute_queue_family(functions, physical));
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.pNext = requirements.features();
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    create.enabledExtensionCount = static_cast<uint32_t>(requirements.extensions().size());
    create.ppEnabledExtensionNames = requirements.extensions().data();
    if (vkCreateDevice(physical, &create, nullptr, &device.device) != VK_SUCCESS) return false;
    volkLoadDevice(device.device);
    device.instance = instance;
    device.physical_device = physical;
    device.queue_family = queue.queueFamilyIndex;
    vkGetDeviceQueue(device.device, device.queue_family, 0, &device.queue);
    device.get_instance_proc_addr = vkGetInstanceProcAddr;
    device.api_version = VK_API_VERSION_1_2;
    device.lock_queue = [this] { ++locked; };
    device.unlock_queue = [this] {
        --locked;
        ++submissions;
    };
    return true;
}

class AdoptedDeviceTest : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!test::make_context()) GTEST_SKIP() << "no usable device";
        ASSERT_TRUE(host_.create());
    }
    Host host_;
};

TEST_F(AdoptedDeviceTest, BothAcceleratorsTraceOnIt) {
    Context context(host_.device);
    std::vector<std::unique_ptr<AbstractAccel>> accels;
    accels.push_back(std::make_unique<SwTlas>(context));
    if (missing_for_hardware(context.facts()).empty()) accels.push_back(std::make_unique<HwTlas>(context));
    for (const std::unique_ptr<AbstractAccel>& accel : accels) {
        accel->push(make_box(vec3(-1), vec3(1)));
        const Ray ray{vec3(0.25f, 0.5f, 5), 0, vec3(0, 0, -1), INFINITY};
        EXPECT_EQ(accel->closest_hits(std::span(&ray, 1)).front().t, 4.0f) << accel->name();
    }
    EXPECT_EQ(host_.locked, 0) << "each lock of the queue is undone";
    EXPECT_GT(host_.submissions, 0);
}

TEST_F(AdoptedDeviceTest, WhatIsNotEnabledIsRefused) {
    host_.device.enabled.timeline_semaphore = false;
    EXPECT_THROW(Context context(host_.device), Error);
}

}  // namespace
}  // namespace twinray
