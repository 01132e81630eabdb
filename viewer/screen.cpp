#define GLFW_INCLUDE_NONE
#include <vulkan/vulkan.h>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <backends/imgui_impl_vulkan.h>

#include "viewer/screen.h"

#include <algorithm>
#include <cstring>

#include "engine/core/error.h"

namespace twinray::viewer {
namespace {

VkImageMemoryBarrier barrier(VkImage image, VkImageLayout from, VkImageLayout to, VkAccessFlags before,
                             VkAccessFlags after) {
    auto change = of_type<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    change.srcAccessMask = before;
    change.dstAccessMask = after;
    change.oldLayout = from;
    change.newLayout = to;
    change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    change.image = image;
    change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    return change;
}

void apply(VkCommandBuffer commands, VkPipelineStageFlags from, VkPipelineStageFlags to,
           const VkImageMemoryBarrier& change) {
    vkCmdPipelineBarrier(commands, from, to, 0, 0, nullptr, 0, nullptr, 1, &change);
}

// Newer releases of Dear ImGui take the render pass as a member.
template <typename Info>
bool init_overlay(Info info, VkRenderPass pass) {
    if constexpr (requires { info.RenderPass; }) {
        info.RenderPass = pass;
        return ImGui_ImplVulkan_Init(&info);
    } else {
        return ImGui_ImplVulkan_Init(&info, pass);
    }
}

}  // namespace

Screen::Screen(GLFWwindow* window, const ContextDesc& desc)
    : window_(window), screen_device_(window, desc), device_(screen_device_.handle()) {
    try {
        create_commands();
        create_pass();
    } catch (...) {
        destroy();
        throw;
    }
}

Screen::~Screen() { destroy(); }

void Screen::destroy() {
    vkDeviceWaitIdle(device_);
    end_overlay();
    destroy_swapchain();
    destroy_picture();
    vkDestroyDescriptorPool(device_, descriptors_, nullptr);
    vkDestroyRenderPass(device_, pass_, nullptr);
    vkDestroySemaphore(device_, is_acquired_, nullptr);
    vkDestroyFence(device_, is_done_, nullptr);
    vkDestroyCommandPool(device_, pool_, nullptr);
}

void Screen::create_commands() {
    auto pool = of_type<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = screen_device_.queue_family();
    require(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "make a command pool");
    auto buffer = of_type<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    buffer.commandPool = pool_;
    buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer.commandBufferCount = 1;
    require(vkAllocateCommandBuffers(device_, &buffer, &commands_), "make a command buffer");
    auto fence = of_type<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    require(vkCreateFence(device_, &fence, nullptr, &is_done_), "make a fence");
    auto semaphore = of_type<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    require(vkCreateSemaphore(device_, &semaphore, nullptr, &is_acquired_), "make a semaphore");
}

// Keeps what is in the image, the picture.
void Screen::create_pass() {
    VkAttachmentDescription target{};
    target.format = screen_device_.format();
    target.samples = VK_SAMPLE_COUNT_1_BIT;
    target.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    target.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    target.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    target.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    target.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    target.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    auto info = of_type<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    info.attachmentCount = 1;
    info.pAttachments = &target;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    require(vkCreateRenderPass(device_, &info, nullptr, &pass_), "make a render pass");
}

void Screen::start_overlay() {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 16};
    auto pool = of_type<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool.maxSets = 16;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    require(vkCreateDescriptorPool(device_, &pool, nullptr, &descriptors_), "make a descriptor pool");
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = screen_device_.instance();
    info.PhysicalDevice = screen_device_.physical_device();
    info.Device = device_;
    info.QueueFamily = screen_device_.queue_family();
    info.Queue = screen_device_.queue();
    info.DescriptorPool = descriptors_;
    info.MinImageCount = 2;
    info.ImageCount = 2;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    if (!init_overlay(info, pass_)) fail("window: Dear ImGui cannot use the device");
    has_overlay_ = true;
#if IMGUI_VERSION_NUM < 19000
    auto begin = of_type<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    require(vkBeginCommandBuffer(commands_, &begin), "begin commands");
    ImGui_ImplVulkan_CreateFontsTexture(commands_);
    require(vkEndCommandBuffer(commands_), "end commands");
    auto submit = of_type<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    require(vkQueueSubmit(screen_device_.queue(), 1, &submit, VK_NULL_HANDLE), "submit");
    require(vkQueueWaitIdle(screen_device_.queue()), "wait for the fonts");
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
}

void Screen::end_overlay() {
    if (!has_overlay_) return;
    vkDeviceWaitIdle(device_);  // fails for a lost device, which does not matter any more
    ImGui_ImplVulkan_Shutdown();
    has_overlay_ = false;
}

// Returns false if the window has no pixels.
bool Screen::create_swapchain() {
    require(vkDeviceWaitIdle(device_), "wait for the device");
    VkSurfaceCapabilitiesKHR can{};
    require(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(screen_device_.physical_device(), screen_device_.surface(), &can),
            "ask the surface");
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    extent_ = can.currentExtent;
    if (extent_.width == UINT32_MAX)
        extent_ = {
            std::clamp(static_cast<std::uint32_t>(width), can.minImageExtent.width, can.maxImageExtent.width),
            std::clamp(static_cast<std::uint32_t>(height), can.minImageExtent.height, can.maxImageExtent.height)};
    if (extent_.width == 0 || extent_.height == 0) return false;
    if ((can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT) == 0)
        fail("window: its images cannot be copied to");
    auto info = of_type<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
    info.surface = screen_device_.surface();
    info.minImageCount = std::max(2u, can.minImageCount);
    info.imageFormat = screen_device_.format();
    info.imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    destroy_swapchain();
    require(vkCreateSwapchainKHR(device_, &info, nullptr, &swapchain_), "make a swapchain");
    std::uint32_t count = 0;
    require(vkGetSwapchainImagesKHR(device_, swapchain_, &count, nullptr), "list its images");
    std::vector<VkImage> images(count);
    require(vkGetSwapchainImagesKHR(device_, swapchain_, &count, images.data()), "list its images");
    for (VkImage image : images) {
        Image made{image, VK_NULL_HANDLE, VK_NULL_HANDLE, VK_NULL_HANDLE};
        auto view = of_type<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
        view.image = image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = screen_device_.format();
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        require(vkCreateImageView(device_, &view, nullptr, &made.view), "view an image");
        auto frame = of_type<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
        frame.renderPass = pass_;
        frame.attachmentCount = 1;
        frame.pAttachments = &made.view;
        frame.width = extent_.width;
        frame.height = extent_.height;
        frame.layers = 1;
        require(vkCreateFramebuffer(device_, &frame, nullptr, &made.framebuffer), "make a frame");
        auto semaphore = of_type<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
        require(vkCreateSemaphore(device_, &semaphore, nullptr, &made.is_drawn), "make a semaphore");
        images_.push_back(made);
    }
    is_out_of_date_ = false;
    return true;
}

void Screen::destroy_swapchain() {
    for (const Image& image : images_) {
        vkDestroySemaphore(device_, image.is_drawn, nullptr);
        vkDestroyFramebuffer(device_, image.framebuffer, nullptr);
        vkDestroyImageView(device_, image.view, nullptr);
    }
    images_.clear();
    if (swapchain_) vkDestroySwapchainKHR(device_, swapchain_, nullptr);
    swapchain_ = VK_NULL_HANDLE;
}

std::uint32_t Screen::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties properties{};
    vkGetPhysicalDeviceMemoryProperties(screen_device_.physical_device(), &properties);
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i)
        if ((allowed >> i & 1u) && (properties.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    fail("window: no memory for a picture");
}

void Screen::destroy_picture() {
    vkDestroyBuffer(device_, staging_, nullptr);
    vkFreeMemory(device_, staging_memory_, nullptr);
    vkDestroyImage(device_, picture_, nullptr);
    vkFreeMemory(device_, picture_memory_, nullptr);
    staging_ = VK_NULL_HANDLE, picture_ = VK_NULL_HANDLE;
    staging_memory_ = picture_memory_ = VK_NULL_HANDLE;
}

void Screen::upload(const Raster& picture) {
    if (picture_extent_.width != picture.width || picture_extent_.height != picture.height) {
        destroy_picture();
        picture_extent_ = {picture.width, picture.height};
        auto buffer = of_type<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
        buffer.size = 4 * picture.pixels.size();
        buffer.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        require(vkCreateBuffer(device_, &buffer, nullptr, &staging_), "make a buffer");
        auto image = of_type<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
        image.imageType = VK_IMAGE_TYPE_2D;
        image.format = VK_FORMAT_R8G8B8A8_UNORM;
        image.extent = {picture.width, picture.height, 1};
        image.mipLevels = image.arrayLayers = 1;
        image.samples = VK_SAMPLE_COUNT_1_BIT;
        image.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        require(vkCreateImage(device_, &image, nullptr, &picture_), "make an image");
        VkMemoryRequirements needs{};
        auto memory = of_type<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
        vkGetBufferMemoryRequirements(device_, staging_, &needs);
        memory.allocationSize = needs.size;
        memory.memoryTypeIndex = memory_type(
            needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        require(vkAllocateMemory(device_, &memory, nullptr, &staging_memory_), "allocate memory");
        require(vkBindBufferMemory(device_, staging_, staging_memory_, 0), "bind memory");
        require(vkMapMemory(device_, staging_memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "map memory");
        vkGetImageMemoryRequirements(device_, picture_, &needs);
        memory.allocationSize = needs.size;
        memory.memoryTypeIndex = memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        require(vkAllocateMemory(device_, &memory, nullptr, &picture_memory_), "allocate memory");
        require(vkBindImageMemory(device_, picture_, picture_memory_, 0), "bind memory");
    }
    auto* out = static_cast<std::uint8_t*>(mapped_);
    for (const Rgb pixel : picture.pixels) {
        const std::uint8_t rgba[] = {pixel.r, pixel.g, pixel.b, 255};
        std::memcpy(out, rgba, 4);
        out += 4;
    }
}

void Screen::record(VkCommandBuffer commands, const Image& target, const Raster& picture) {
    constexpr auto undefined = VK_IMAGE_LAYOUT_UNDEFINED;
    constexpr auto to = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, from = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    constexpr auto write = VK_ACCESS_TRANSFER_WRITE_BIT, read = VK_ACCESS_TRANSFER_READ_BIT;
    constexpr auto transfer = VK_PIPELINE_STAGE_TRANSFER_BIT;
    constexpr auto output = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    apply(commands, transfer, transfer, barrier(picture_, undefined, to, 0, write));
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {picture.width, picture.height, 1};
    vkCmdCopyBufferToImage(commands, staging_, picture_, to, 1, &copy);
    apply(commands, transfer, transfer, barrier(picture_, to, from, write, read));
    apply(commands, output, transfer, barrier(target.image, undefined, to, 0, write));
    VkImageBlit blit{};
    blit.srcSubresource = blit.dstSubresource = copy.imageSubresource;
    blit.srcOffsets[1] = {static_cast<int>(picture.width), static_cast<int>(picture.height), 1};
    blit.dstOffsets[1] = {static_cast<int>(extent_.width), static_cast<int>(extent_.height), 1};
    vkCmdBlitImage(commands, picture_, from, target.image, to, 1, &blit, VK_FILTER_NEAREST);
    apply(commands, transfer, output,
          barrier(target.image, to, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, write,
                  VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT));
    auto begin = of_type<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    begin.renderPass = pass_;
    begin.framebuffer = target.framebuffer;
    begin.renderArea.extent = extent_;
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    if (ImDrawData* drawn = ImGui::GetDrawData()) ImGui_ImplVulkan_RenderDrawData(drawn, commands);
    vkCmdEndRenderPass(commands);
}

bool Screen::present(const Raster& picture) {
    int width = 0, height = 0;  // some systems do not tell of another size by themselves
    glfwGetFramebufferSize(window_, &width, &height);
    const VkExtent2D now{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    is_out_of_date_ |= now.width != extent_.width || now.height != extent_.height;
    if (now.width == 0 || now.height == 0 || (is_out_of_date_ && !create_swapchain())) return false;
    std::uint32_t index = 0;
    const VkResult acquired =
        vkAcquireNextImageKHR(device_, swapchain_, UINT64_MAX, is_acquired_, VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        is_out_of_date_ = true;
        return true;
    }
    if (acquired != VK_SUBOPTIMAL_KHR) require(acquired, "get an image");
    upload(picture);
    require(vkResetFences(device_, 1, &is_done_), "reset a fence");
    auto begin = of_type<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    require(vkBeginCommandBuffer(commands_, &begin), "begin commands");
    record(commands_, images_[index], picture);
    require(vkEndCommandBuffer(commands_), "end commands");
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    auto submit = of_type<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submit.waitSemaphoreCount = 1;
    submit.pWaitSemaphores = &is_acquired_;
    submit.pWaitDstStageMask = &stage;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    submit.signalSemaphoreCount = 1;
    submit.pSignalSemaphores = &images_[index].is_drawn;
    require(vkQueueSubmit(screen_device_.queue(), 1, &submit, is_done_), "submit");
    auto present = of_type<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
    present.waitSemaphoreCount = 1;
    present.pWaitSemaphores = &images_[index].is_drawn;
    present.swapchainCount = 1;
    present.pSwapchains = &swapchain_;
    present.pImageIndices = &index;
    const VkResult shown = vkQueuePresentKHR(screen_device_.queue(), &present);
    require(vkWaitForFences(device_, 1, &is_done_, VK_TRUE, UINT64_MAX), "wait for the frame");
    is_out_of_date_ = shown == VK_ERROR_OUT_OF_DATE_KHR || shown == VK_SUBOPTIMAL_KHR || acquired == VK_SUBOPTIMAL_KHR;
    if (!is_out_of_date_) require(shown, "show an image");
    return true;
}

void Screen::wait() const { require(vkDeviceWaitIdle(device_), "wait for the device"); }

}  // namespace twinray::viewer
