// SPDX-License-Identifier: MIT
// The renderer's own Vulkan: instance, device, queue, allocator. twinray comes in as a guest.
#pragma once

#include <vulkan/vulkan.h>

#include <functional>
#include <string>
#include <vector>

#include <twinray/context.h>

typedef struct VmaAllocator_T* VmaAllocator;

namespace twinray::embed_renderer {

struct DeviceDesc {
    std::string device = {};  // "" = best; an index or a part of the name
    bool validation = false;
    bool use_ray_query = true;             // false: do not enable it although the device has it
    bool use_ray_tracing_pipeline = true;  // likewise
    Log log = {};                          // what twinray and the validation layer say
};

class Device {
  public:
    explicit Device(const DeviceDesc& desc);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkDevice handle() const { return device_; }
    VkPhysicalDevice physical() const { return physical_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    VmaAllocator allocator() const { return allocator_; }
    double timestamp_period_ns() const { return timestamp_period_ns_; }

    // What twinray is told: nothing but what was enabled here, and this renderer's allocator.
    AdoptedDevice adopted() const;
    // Records, submits and waits.
    void run_once(const std::function<void(VkCommandBuffer)>& record) const;
    std::uint64_t validation_message_count() const { return message_count_; }
    std::uint32_t live_allocations() const;

  private:
    static VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT*, void*);
    void create_instance(bool validation);
    void choose(const std::string& request);
    void create_device(const DeviceDesc& desc);
    void create_allocator();
    void destroy();

    Log log_;
    std::uint64_t message_count_ = 0;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    double timestamp_period_ns_ = 0;
    DeviceProperties enabled_;
    VmaAllocator allocator_ = nullptr;
};

// Throws Error naming the action unless it succeeded.
void require(VkResult result, const char* action);

}  // namespace twinray::embed_renderer
