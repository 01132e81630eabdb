// SPDX-License-Identifier: MIT
#include "device.h"

#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace renderer {
namespace {

constexpr std::uint32_t api_version = VK_API_VERSION_1_2;

// Returns the family of queues that rasterises and computes; -1: none.
int universal_family(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & wanted) == wanted) return static_cast<int>(i);
    return -1;
}

VkDeviceMemory allocated(const Device& device, const VkMemoryRequirements& needed, VkMemoryPropertyFlags flags) {
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(device.physical(), &types);
    const auto fits = [&](std::uint32_t i) {
        return (needed.memoryTypeBits >> i & 1u) && (types.memoryTypes[i].propertyFlags & flags) == flags;
    };
    std::uint32_t type = 0;
    while (type < types.memoryTypeCount && !fits(type)) ++type;
    if (type == types.memoryTypeCount) throw std::runtime_error("no memory is of the kind that the renderer needs");
    auto by_address = of_type<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
    by_address.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    auto info = of_type<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    info.pNext = &by_address;
    info.allocationSize = needed.size;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    require(vkAllocateMemory(device.handle(), &info, nullptr, &memory), "allocate memory");
    return memory;
}

}  // namespace

void require(VkResult result, const char* action) {
    if (result != VK_SUCCESS)
        throw std::runtime_error("cannot " + std::string(action) + ": VkResult " + std::to_string(result));
}

// It delegates, so that the destructor runs if anything here throws.
Device::Device(RayTracing ray_tracing) : Device() {
    create_instance();
    choose();
    create_device(ray_tracing);
}

Device::~Device() {
    if (device_) vkDestroyDevice(device_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

void Device::create_instance() {
    auto application = of_type<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pApplicationName = "embedding";
    application.apiVersion = api_version;
    auto info = of_type<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    require(vkCreateInstance(&info, nullptr, &instance_), "create an instance");
}

// [choose]
// Chooses the first device that rasterises and on which twinray can run.
void Device::choose() {
    std::uint32_t count = 0;
    require(vkEnumeratePhysicalDevices(instance_, &count, nullptr), "list the devices");
    std::vector<VkPhysicalDevice> devices(count);
    require(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "list the devices");
    std::string lacking;
    for (const VkPhysicalDevice device : devices) {
        const int family = universal_family(device);
        if (family < 0) continue;
        const auto properties = twinray::query_device_properties(vkGetInstanceProcAddr, instance_, device);
        const std::vector<std::string> missing = twinray::missing_for_software(properties);
        if (missing.empty()) {
            physical_ = device;
            queue_family_ = static_cast<std::uint32_t>(family);
            return;
        }
        for (const std::string& what : missing) lacking += "\n  " + properties.name + ": " + what;
    }
    throw std::runtime_error("no device rasterises and runs twinray" + lacking);
}
// [/choose]

void Device::create_device(RayTracing ray_tracing) {
    // [own]
    const float priority = 1;
    auto queue = of_type<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    auto own = of_type<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    own.timelineSemaphore = VK_TRUE;    // frames in flight
    own.bufferDeviceAddress = VK_TRUE;  // shaders find everything by address
    own.scalarBlockLayout = VK_TRUE;
    auto info = of_type<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.pNext = &own;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    // [needs]
    auto supported = twinray::query_device_properties(vkGetInstanceProcAddr, instance_, physical_);
    if (ray_tracing == RayTracing::off)
        supported.acceleration_structure = supported.ray_query = supported.ray_tracing_pipeline = false;
    if (ray_tracing == RayTracing::pipelines) supported.ray_query = false;
    twinray::DeviceRequirements needs(supported);
    needs.add_to(info);
    require(vkCreateDevice(physical_, &info, nullptr, &device_), "create a device");
    enabled_ = twinray::enabled_properties(vkGetInstanceProcAddr, instance_, physical_, info);
    // [/needs]
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
}

// [adopted]
twinray::AdoptedDevice Device::adopted() const {
    twinray::AdoptedDevice adopted;
    adopted.instance = instance_;
    adopted.physical_device = physical_;
    adopted.device = device_;
    adopted.queue = queue_;
    adopted.queue_family = queue_family_;
    adopted.get_instance_proc_addr = vkGetInstanceProcAddr;
    adopted.api_version = api_version;  // of VkApplicationInfo
    adopted.enabled = enabled_;
    return adopted;
}
// [/adopted]

void Device::run_once(const std::function<void(VkCommandBuffer)>& record) const {
    auto pool_info = of_type<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool_info.queueFamilyIndex = queue_family_;
    VkCommandPool pool = VK_NULL_HANDLE;
    require(vkCreateCommandPool(device_, &pool_info, nullptr, &pool), "create a command pool");
    auto allocate = of_type<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    require(vkAllocateCommandBuffers(device_, &allocate, &commands), "allocate a command buffer");
    const auto begin = of_type<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    require(vkBeginCommandBuffer(commands, &begin), "begin a command buffer");
    record(commands);
    require(vkEndCommandBuffer(commands), "end a command buffer");
    auto submit = of_type<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    require(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "submit");
    require(vkQueueWaitIdle(queue_), "wait for the queue");
    vkDestroyCommandPool(device_, pool, nullptr);
}

// [buffer]
Buffer::Buffer(const Device& device, VkDeviceSize bytes, Place place, VkBufferUsageFlags more_usage)
    : device_(&device), bytes_(bytes) {
    auto info = of_type<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | more_usage;
    // [/buffer]
    require(vkCreateBuffer(device.handle(), &info, nullptr, &handle_), "create a buffer");
    VkMemoryRequirements needed;
    vkGetBufferMemoryRequirements(device.handle(), handle_, &needed);
    const bool is_mapped = place == Place::host;
    memory_ = allocated(device, needed,
                        is_mapped ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                                  : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    require(vkBindBufferMemory(device.handle(), handle_, memory_, 0), "bind memory");
    if (is_mapped) require(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "map memory");
    auto asked = of_type<VkBufferDeviceAddressInfo>(VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO);
    asked.buffer = handle_;
    address_ = vkGetBufferDeviceAddress(device.handle(), &asked);
}

Buffer::~Buffer() {
    if (!device_) return;
    vkDestroyBuffer(device_->handle(), handle_, nullptr);
    vkFreeMemory(device_->handle(), memory_, nullptr);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(memory_, other.memory_);
    std::swap(bytes_, other.bytes_);
    std::swap(address_, other.address_);
    std::swap(mapped_, other.mapped_);
    return *this;
}

Buffer uploaded(const Device& device, std::span<const std::byte> data) {
    const Buffer staging(device, data.size(), Buffer::Place::host);
    std::memcpy(staging.mapped(), data.data(), data.size());
    Buffer buffer(device, data.size());
    device.run_once([&](VkCommandBuffer commands) {
        const VkBufferCopy all{0, 0, data.size()};
        vkCmdCopyBuffer(commands, staging.handle(), buffer.handle(), 1, &all);
    });
    return buffer;
}

Image::Image(const Device& owner, VkFormat format, VkExtent2D size, VkImageUsageFlags usage, VkImageAspectFlags aspect)
    : device(owner) {
    auto info = of_type<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {size.width, size.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    require(vkCreateImage(device.handle(), &info, nullptr, &handle), "create an image");
    VkMemoryRequirements needed;
    vkGetImageMemoryRequirements(device.handle(), handle, &needed);
    memory = allocated(device, needed, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    require(vkBindImageMemory(device.handle(), handle, memory, 0), "bind memory");
    auto view_info = of_type<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view_info.image = handle;
    view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view_info.format = format;
    view_info.subresourceRange = {aspect, 0, 1, 0, 1};
    require(vkCreateImageView(device.handle(), &view_info, nullptr, &view), "create a view");
}

Image::~Image() {
    vkDestroyImageView(device.handle(), view, nullptr);
    vkDestroyImage(device.handle(), handle, nullptr);
    vkFreeMemory(device.handle(), memory, nullptr);
}

}  // namespace renderer
