// A program that has Vulkan already: its own way to call it, its own device, its own memory allocator. twinray comes
// in as a guest and must neither replace nor disturb any of them. Exits with 0 if all of it works.
#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>

#include <twinray/tlas.h>

// These come after twinray's headers, which must not decide for them whether vk* are functions.
#ifdef VK_NO_PROTOTYPES
#include <volk.h>
#else
#include <vulkan/vulkan.h>
#endif
#include <vk_mem_alloc.h>

#include <twinray/vma_adapter.h>

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

    twinray::DeviceRequirements requirements(
        twinray::query_device_properties(vkGetInstanceProcAddr, host.instance, host.physical_device));
    for (const std::string& sentence : requirements.sentences()) std::cout << sentence << '\n';
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = host.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo device{};
    device.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    VkPhysicalDeviceVulkan12Features own{};
    own.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    own.hostQueryReset = VK_TRUE;
    device.pNext = &own;
    device.queueCreateInfoCount = 1;
    device.pQueueCreateInfos = &queue;
    requirements.add_to(device);
    require(vkCreateDevice(host.physical_device, &device, nullptr, &host.device) == VK_SUCCESS, "no device");
    vkGetDeviceQueue(host.device, host.queue_family, 0, &host.queue);
    host.enabled = twinray::enabled_properties(vkGetInstanceProcAddr, host.instance, host.physical_device, device);
    return host;
}

VmaAllocator create_allocator(const twinray::AdoptedDevice& host) {
    VmaVulkanFunctions functions{};
    functions.vkGetInstanceProcAddr = vkGetInstanceProcAddr;
    functions.vkGetDeviceProcAddr = vkGetDeviceProcAddr;
    VmaAllocatorCreateInfo info{};
    info.flags = VMA_ALLOCATOR_CREATE_BUFFER_DEVICE_ADDRESS_BIT;
    info.instance = host.instance;
    info.physicalDevice = host.physical_device;
    info.device = host.device;
    info.vulkanApiVersion = host.api_version;
    info.pVulkanFunctions = &functions;
    VmaAllocator allocator = nullptr;
    require(vmaCreateAllocator(&info, &allocator) == VK_SUCCESS, "the host's allocator cannot be created");
    return allocator;
}

std::uint32_t live_allocations(VmaAllocator allocator) {
    VmaTotalStatistics statistics;
    vmaCalculateStatistics(allocator, &statistics);
    return statistics.total.statistics.allocationCount;
}

void trace(twinray::AbstractAccel& accel) {
    accel.push(twinray::make_box(twinray::vec3(-1), twinray::vec3(1)));
    const twinray::Ray ray{{0.25f, 0.5f, 5}, 0, {0, 0, -1}, std::numeric_limits<float>::infinity()};
    const twinray::Hit hit = accel.closest_hits({&ray, 1}).front();
    std::cout << accel.name() << ": t = " << hit.t << '\n';
    require(hit.t == 4, "the box is 4 away");
}

// An exception of the library is caught by its type on this side of the boundary.
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

void trace_with_both(const twinray::AdoptedDevice& host) {
    twinray::Context context(host);
    twinray::SwTlas software(context);
    trace(software);
    if (!twinray::missing_for_hardware(context.properties()).empty()) return;
    twinray::HwTlas hardware(context);
    trace(hardware);
}

// All memory of twinray's comes from the host's allocator, and goes back to it.
void trace_in_memory_of(VmaAllocator allocator, twinray::AdoptedDevice host) {
    host.allocator = twinray::hooks_of(allocator);
    std::uint32_t most = 0;
    host.lock_queue = [&] { most = std::max(most, live_allocations(allocator)); };
    trace_with_both(host);
    std::cout << "up to " << most << " buffers in the host's allocator\n";
    require(most > 10, "the host's allocator does not see twinray's buffers");
    require(live_allocations(allocator) == 0, "twinray kept memory of the host's allocator");
}

}  // namespace

int main() try {
    const twinray::AdoptedDevice host = create_device();
    VmaAllocator allocator = create_allocator(host);
    trace_with_both(host);
    require(live_allocations(allocator) == 0, "the host's allocator holds what is not the host's");
    trace_in_memory_of(allocator, host);
    require_that_errors_arrive(host);
    vmaDestroyAllocator(allocator);
    vkDestroyDevice(host.device, nullptr);
    vkDestroyInstance(host.instance, nullptr);
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
