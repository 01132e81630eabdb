// SPDX-License-Identifier: MIT
// A Vulkan device that can show pictures in a window: made here, adopted by twinray's Context.
#pragma once

#include <optional>
#include <string>

#include <twinray/context.h>

struct GLFWwindow;

namespace twinray::viewer {

// Throws Error that says what failed.
void require(VkResult result, const char* action);

class ScreenDevice {
  public:
    // Throws Error where no device both runs twinray and shows pictures there.
    ScreenDevice(GLFWwindow* window, const ContextDesc& desc);
    ~ScreenDevice();
    ScreenDevice(const ScreenDevice&) = delete;
    ScreenDevice& operator=(const ScreenDevice&) = delete;

    AdoptedDevice adopted() const;
    std::uint64_t validation_messages() const { return message_count_; }
    VkInstance instance() const { return instance_; }
    VkSurfaceKHR surface() const { return surface_; }
    VkPhysicalDevice physical_device() const { return physical_; }
    VkDevice handle() const { return device_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queue_family() const { return family_; }
    VkFormat format() const { return format_; }  // of the window, 8 bits a channel as they are

  private:
    void destroy();
    void create_instance(const ContextDesc& desc);
    void choose(const std::string& request);
    void choose_format();
    void create_device(const ContextDesc& desc);
    static VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user);

    std::optional<double> most_submission_seconds_;
    Log log_;
    std::uint64_t message_count_ = 0;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    std::uint32_t family_ = 0;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    DeviceProperties enabled_;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
};

}  // namespace twinray::viewer
