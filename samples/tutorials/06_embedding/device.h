// SPDX-License-Identifier: MIT
// The renderer's own Vulkan: instance, device, queue. twinray uses them as a guest.
#pragma once

#include <vulkan/vulkan.h>

#include <functional>

#include <twinray/context.h>

namespace renderer {

// off: like a device without ray tracing. pipelines: like one without ray queries.
enum class RayTracing { if_there, pipelines, off };

class Device {
  public:
    explicit Device(RayTracing ray_tracing);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkDevice handle() const { return device_; }
    VkPhysicalDevice physical() const { return physical_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    // The description of the device for twinray.
    twinray::AdoptedDevice adopted() const;
    // Records, submits and waits, for work that is done once.
    void run_once(const std::function<void(VkCommandBuffer)>& record) const;

  private:
    Device() = default;
    void create_instance();
    void choose();
    void create_device(RayTracing ray_tracing);

    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    twinray::DeviceProperties enabled_;
};

// Throws an exception that names the action unless it succeeded.
void require(VkResult result, const char* action);

// A struct of Vulkan, all zero but for its type.
template <class Struct>
Struct of_type(VkStructureType type) {
    Struct value{};
    value.sType = type;
    return value;
}

}  // namespace renderer
