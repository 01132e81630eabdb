// Pictures in a window, with what Dear ImGui draws over them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <twinray/context.h>

#include "viewer/picture/raster.h"

struct GLFWwindow;

namespace twinray::viewer {

// Throws Error that says what failed.
void require(VkResult result, const char* action);

// A struct of Vulkan, all zero but for its type.
template <class Struct>
Struct of_type(VkStructureType type) {
    Struct value{};
    value.sType = type;
    return value;
}

// A Vulkan device that can show pictures in a window: made here, adopted by twinray's Context.
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
    VkFormat format() const { return format_; }  // of the window, 8 bits per channel as they are

  private:
    ScreenDevice() = default;
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

class Screen {
  public:
    // Throws Error as ScreenDevice does.
    Screen(GLFWwindow* window, const ContextDesc& desc);
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    const ScreenDevice& device() const { return screen_device_; }

    // Starts Dear ImGui, which draws over pictures, for this device. Its context must exist.
    void start_overlay();
    void end_overlay();  // before its context ends
    // Shows the picture, enlarged to the window, and what ImGui draws. Returns false if the window has no pixels now.
    bool present(const Raster& picture);
    void wait() const;

  private:
    struct Image {  // of the swapchain
        VkImage image;
        VkImageView view;
        VkFramebuffer framebuffer;
        VkSemaphore is_drawn;
    };

    void destroy();
    void create_commands();
    void create_pass();
    bool create_swapchain();
    void destroy_swapchain();
    void upload(const Raster& picture);
    void destroy_picture();
    void record(VkCommandBuffer commands, const Image& target, const Raster& picture);
    std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const;

    GLFWwindow* window_;
    ScreenDevice screen_device_;
    VkDevice device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence is_done_ = VK_NULL_HANDLE;
    VkSemaphore is_acquired_ = VK_NULL_HANDLE;
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D extent_{};
    std::vector<Image> images_;
    bool is_out_of_date_ = true, has_overlay_ = false;
    VkBuffer staging_ = VK_NULL_HANDLE;  // the picture's pixels
    VkDeviceMemory staging_memory_ = VK_NULL_HANDLE;
    VkImage picture_ = VK_NULL_HANDLE;
    VkDeviceMemory picture_memory_ = VK_NULL_HANDLE;
    void* mapped_ = nullptr;
    VkExtent2D picture_extent_{};
};

}  // namespace twinray::viewer
