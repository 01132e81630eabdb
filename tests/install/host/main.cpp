// SPDX-License-Identifier: MIT
// A program that has Vulkan already: its own way to call it, its own device, its own memory allocator. twinray comes
// in as a guest and must neither replace nor disturb any of them. Exits with 0 if all of it works.
#include <cstring>
#include <iostream>
#include <limits>
#include <memory>

#include "engine/core/error.h"
#include "engine/scene/shapes.h"
#include "hwtlas/hw_tlas.h"
#include "swtlas/sw_tlas.h"

// After twinray's headers, which must not decide for these whether vk* are functions.
#ifdef VK_NO_PROTOTYPES
#include <volk.h>
#else
#include <vulkan/vulkan.h>
#endif
#include <vk_mem_alloc.h>

namespace {

void require(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(what);
}

twinray::AdoptedDevice create_device() {
#ifdef VK_NO_PROTOTYPES
    require(volkInitialize() == VK_SUCCESS, "volk finds no Vulkan loader");
#endif
    twinray::AdoptedDevice host;
    host.get_instance_proc_addr = vkGetInstanceProcAddr;
    host.api_version = VK_API_VERSION_1_2;
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = host.api_version;
    VkInstanceCreateInfo instance{};
    instance.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    instance.pApplicationInfo = &application;
    require(vkCreateInstance(&instance, nullptr, &host.instance) == VK_SUCCESS, "no instance");
#ifdef VK_NO_PROTOTYPES
    volkLoadInstance(host.instance);
#endif
    std::uint32_t count = 1;
    vkEnumeratePhysicalDevices(host.instance, &count, &host.physical_device);
    require(count == 1, "no device");

    twinray::VulkanFunctions functions;
    functions.load_global(vkGetInstanceProcAddr);
    functions.load_instance(host.instance);
    host.enabled = twinray::query_device_facts(functions, host.physical_device);
    host.queue_family = static_cast<std::uint32_t>(twinray::compute_queue_family(functions, host.physical_device));
    const twinray::DeviceRequirements requirements(host.enabled);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = host.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo device{};
    device.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    device.pNext = requirements.features();
    device.queueCreateInfoCount = 1;
    device.pQueueCreateInfos = &queue;
    device.enabledExtensionCount = static_cast<std::uint32_t>(requirements.extensions().size());
    device.ppEnabledExtensionNames = requirements.extensions().data();
    require(vkCreateDevice(host.physical_device, &device, nullptr, &host.device) == VK_SUCCESS, "no device");
    vkGetDeviceQueue(host.device, host.queue_family, 0, &host.queue);
    return host;
}

VmaAllocator create_allocator(const twinray::AdoptedDevice& host) {
    VmaVulkanFunctions functions{};
    functions.vkGetInstanceProcAddr = vkGetInstanceProcAddr;
    functions.vkGetDeviceProcAddr = vkGetDeviceProcAddr;
    VmaAllocatorCreateInfo info{};
    info.instance = host.instance;
    info.physicalDevice = host.physical_device;
    info.device = host.device;
    info.vulkanApiVersion = host.api_version;
    info.pVulkanFunctions = &functions;
    VmaAllocator allocator = nullptr;
    require(vmaCreateAllocator(&info, &allocator) == VK_SUCCESS, "the host's allocator cannot be created");
    return allocator;
}

// A mapped buffer of the host's own, written and read while twinray's memory lives beside it.
void use_allocator(VmaAllocator allocator) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = 4096;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    VmaAllocationCreateInfo memory{};
    memory.usage = VMA_MEMORY_USAGE_AUTO;
    memory.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT | VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    VmaAllocation allocation = nullptr;
    VmaAllocationInfo mapped{};
    require(vmaCreateBuffer(allocator, &info, &memory, &buffer, &allocation, &mapped) == VK_SUCCESS,
            "the host's buffer cannot be created");
    std::memset(mapped.pMappedData, 42, info.size);
    require(static_cast<const char*>(mapped.pMappedData)[info.size - 1] == 42, "the host's buffer is not mapped");
    VmaTotalStatistics statistics;
    vmaCalculateStatistics(allocator, &statistics);
    require(statistics.total.statistics.allocationCount == 1, "the host's allocator holds what is not the host's");
    vmaDestroyBuffer(allocator, buffer, allocation);
}

void trace(twinray::AbstractAccel& accel) {
    accel.push(twinray::make_box(twinray::vec3(-1), twinray::vec3(1)));
    const twinray::Ray ray{{0.25f, 0.5f, 5}, 0, {0, 0, -1}, std::numeric_limits<float>::infinity()};
    const twinray::Hit hit = accel.closest_hits({&ray, 1}).front();
    std::cout << accel.name() << ": t = " << hit.t << '\n';
    require(hit.t == 4, "the box is 4 away");
}

// What the library throws is caught by its type on this side of the boundary.
void require_that_errors_arrive(twinray::AdoptedDevice host) {
    host.enabled.timeline_semaphore = false;
    try {
        const twinray::Context context(host);
    } catch (const twinray::Error& error) {
        std::cout << "refused as it should be: " << error.what() << '\n';
        return;
    }
    require(false, "a device without timeline semaphores was accepted");
}

}  // namespace

int main() try {
    const twinray::AdoptedDevice host = create_device();
    VmaAllocator allocator = create_allocator(host);
    {
        twinray::Context context(host);
        twinray::SwTlas software(context);
        trace(software);
        if (twinray::missing_for_hardware(context.facts()).empty()) {
            twinray::HwTlas hardware(context);
            trace(hardware);
        }
        use_allocator(allocator);
    }
    require_that_errors_arrive(host);
    vmaDestroyAllocator(allocator);
    vkDestroyDevice(host.device, nullptr);
    vkDestroyInstance(host.instance, nullptr);
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
