// SPDX-License-Identifier: MIT
// Pictures in a window, with what Dear ImGui draws over them.
#pragma once

#include <vector>

#include "viewer/picture/raster.h"
#include "viewer/screen_device.h"

namespace twinray::viewer {

class Screen {
  public:
    // Throws Error as ScreenDevice does.
    Screen(GLFWwindow* window, const ContextDesc& desc);
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    const ScreenDevice& device() const { return screen_device_; }

    // Begins what draws over pictures: Dear ImGui for this device. After its context is there.
    void start_overlay();
    void end_overlay();  // before its context ends
    // Shows the picture, enlarged to the window, and what ImGui has to draw. False: the window has no pixels now.
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
