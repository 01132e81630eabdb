// SPDX-License-Identifier: MIT
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

constexpr std::uint32_t api_version = VK_API_VERSION_1_2;

void require(VkResult result, const char* action) {
    if (result != VK_SUCCESS) fail("window: ", action, ": VkResult ", static_cast<int>(result));
}

template <class Function>
Function instance_function(VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

// Draws, computes and shows there; -1 if there is none.
int family_of(VkPhysicalDevice device, VkSurfaceKHR surface) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i) {
        VkBool32 shows = VK_FALSE;
        if (vkGetPhysicalDeviceSurfaceSupportKHR(device, i, surface, &shows) != VK_SUCCESS) continue;
        if (shows && (families[i].queueFlags & wanted) == wanted) return static_cast<int>(i);
    }
    return -1;
}

VkImageMemoryBarrier barrier(VkImage image, VkImageLayout from, VkImageLayout to, VkAccessFlags before,
                             VkAccessFlags after) {
    VkImageMemoryBarrier change{};
    change.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
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

}  // namespace

Screen::Screen(GLFWwindow* window, const ContextDesc& desc)
    : window_(window), most_submission_seconds_(desc.most_submission_seconds), log_(desc.log) {
    try {
        create_instance(desc);
        require(glfwCreateWindowSurface(instance_, window_, nullptr, &surface_), "make a surface");
        choose(desc.device);
        create_device(desc);
        create_commands();
        create_pass();
    } catch (...) {
        destroy();
        throw;
    }
}

Screen::~Screen() { destroy(); }

void Screen::destroy() {
    if (device_) {
        vkDeviceWaitIdle(device_);
        end_overlay();
        destroy_swapchain();
        destroy_picture();
        vkDestroyDescriptorPool(device_, descriptors_, nullptr);
        vkDestroyRenderPass(device_, pass_, nullptr);
        vkDestroySemaphore(device_, is_acquired_, nullptr);
        vkDestroyFence(device_, is_done_, nullptr);
        vkDestroyCommandPool(device_, pool_, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    if (surface_) vkDestroySurfaceKHR(instance_, surface_, nullptr);
    if (messenger_)
        instance_function<PFN_vkDestroyDebugUtilsMessengerEXT>(instance_, "vkDestroyDebugUtilsMessengerEXT")(
            instance_, messenger_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

VkBool32 VKAPI_PTR Screen::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                      const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& screen = *static_cast<Screen*>(user);
    ++screen.message_count_;
    if (screen.log_) screen.log_(data->pMessage);
    return VK_FALSE;
}

void Screen::create_instance(const ContextDesc& desc) {
    std::uint32_t count = 0;
    const char** needed = glfwGetRequiredInstanceExtensions(&count);
    if (!needed) fail("window: this system has no Vulkan that shows pictures");
    std::vector<const char*> extensions(needed, needed + count);
    const char* layer = "VK_LAYER_KHRONOS_validation";
    if (desc.validation)
        extensions.insert(extensions.end(),
                          {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME});
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "twinray view";
    application.apiVersion = api_version;
    const VkValidationFeatureEnableEXT synchronisation = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronisation;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pNext = desc.validation ? &features : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = desc.validation ? 1 : 0;
    info.ppEnabledLayerNames = &layer;
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    require(vkCreateInstance(&info, nullptr, &instance_), "make an instance");
    if (!desc.validation) return;
    VkDebugUtilsMessengerCreateInfoEXT listen{};
    listen.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    listen.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    listen.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    listen.pfnUserCallback = on_message;
    listen.pUserData = this;
    const auto create =
        instance_function<PFN_vkCreateDebugUtilsMessengerEXT>(instance_, "vkCreateDebugUtilsMessengerEXT");
    require(create(instance_, &listen, nullptr, &messenger_), "listen to the validation layer");
}

void Screen::choose(const std::string& request) {
    std::uint32_t count = 0;
    require(vkEnumeratePhysicalDevices(instance_, &count, nullptr), "list the devices");
    std::vector<VkPhysicalDevice> devices(count);
    require(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "list the devices");
    std::vector<DeviceProperties> properties;
    for (VkPhysicalDevice device : devices) {
        properties.push_back(query_device_properties(vkGetInstanceProcAddr, instance_, device));
        properties.back().has_compute_queue = family_of(device, surface_) >= 0;
    }
    const DeviceChoice choice = choose_device(properties, request);
    if (choice.index < 0) {
        std::string why;
        for (const std::string& rejection : choice.rejections) why += "\n  " + rejection;
        fail("window: no device runs twinray and shows pictures here", why);
    }
    physical_ = devices[static_cast<std::size_t>(choice.index)];
    family_ = static_cast<std::uint32_t>(family_of(physical_, surface_));
    choose_format();
}

// One that takes 8 bits a channel as they are.
void Screen::choose_format() {
    std::uint32_t count = 0;
    require(vkGetPhysicalDeviceSurfaceFormatsKHR(physical_, surface_, &count, nullptr), "list formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    require(vkGetPhysicalDeviceSurfaceFormatsKHR(physical_, surface_, &count, formats.data()), "list formats");
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
                format_ = wanted;
                return;
            }
    fail("window: it has no format of 8 bits a channel");
}

void Screen::create_device(const ContextDesc& desc) {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    const char* own = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &own;
    DeviceProperties wanted = query_device_properties(vkGetInstanceProcAddr, instance_, physical_);
    wanted.ray_query &= desc.use_ray_query;
    wanted.ray_tracing_pipeline &= desc.use_ray_tracing_pipeline;
    DeviceRequirements requirements(wanted);
    requirements.add_to(info);
    require(vkCreateDevice(physical_, &info, nullptr, &device_), "make a device");
    enabled_ = enabled_properties(vkGetInstanceProcAddr, instance_, physical_, info);
    vkGetDeviceQueue(device_, family_, 0, &queue_);
}

void Screen::create_commands() {
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = family_;
    require(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "make a command pool");
    VkCommandBufferAllocateInfo buffer{};
    buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffer.commandPool = pool_;
    buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer.commandBufferCount = 1;
    require(vkAllocateCommandBuffers(device_, &buffer, &commands_), "make a command buffer");
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    require(vkCreateFence(device_, &fence, nullptr, &is_done_), "make a fence");
    VkSemaphoreCreateInfo semaphore{};
    semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    require(vkCreateSemaphore(device_, &semaphore, nullptr, &is_acquired_), "make a semaphore");
}

// Keeps what is in the image, the picture.
void Screen::create_pass() {
    VkAttachmentDescription target{};
    target.format = format_;
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
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 1;
    info.pAttachments = &target;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    require(vkCreateRenderPass(device_, &info, nullptr, &pass_), "make a render pass");
}

AdoptedDevice Screen::adopted() const {
    AdoptedDevice adopted;
    adopted.instance = instance_;
    adopted.physical_device = physical_;
    adopted.device = device_;
    adopted.queue = queue_;
    adopted.queue_family = family_;
    adopted.get_instance_proc_addr = vkGetInstanceProcAddr;
    adopted.api_version = api_version;
    adopted.enabled = enabled_;
    adopted.most_submission_seconds = most_submission_seconds_;
    adopted.log = log_;
    return adopted;
}

void Screen::start_overlay() {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 16};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool.maxSets = 16;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    require(vkCreateDescriptorPool(device_, &pool, nullptr, &descriptors_), "make a descriptor pool");
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = instance_;
    info.PhysicalDevice = physical_;
    info.Device = device_;
    info.QueueFamily = family_;
    info.Queue = queue_;
    info.DescriptorPool = descriptors_;
    info.MinImageCount = 2;
    info.ImageCount = 2;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    if (!ImGui_ImplVulkan_Init(&info, pass_)) fail("window: Dear ImGui cannot use the device");
    has_overlay_ = true;
#if IMGUI_VERSION_NUM < 19000
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    require(vkBeginCommandBuffer(commands_, &begin), "begin commands");
    ImGui_ImplVulkan_CreateFontsTexture(commands_);
    require(vkEndCommandBuffer(commands_), "end commands");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    require(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "submit");
    require(vkQueueWaitIdle(queue_), "wait for the fonts");
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
}

void Screen::end_overlay() {
    if (!has_overlay_) return;
    vkDeviceWaitIdle(device_);  // of a device that is lost it fails, which does not matter any more
    ImGui_ImplVulkan_Shutdown();
    has_overlay_ = false;
}

// False: the window has no pixels.
bool Screen::create_swapchain() {
    require(vkDeviceWaitIdle(device_), "wait for the device");
    VkSurfaceCapabilitiesKHR can{};
    require(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical_, surface_, &can), "ask the surface");
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
    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = surface_;
    info.minImageCount = std::max(2u, can.minImageCount);
    info.imageFormat = format_;
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
        VkImageViewCreateInfo view{};
        view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        view.image = image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format_;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        require(vkCreateImageView(device_, &view, nullptr, &made.view), "view an image");
        VkFramebufferCreateInfo frame{};
        frame.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
        frame.renderPass = pass_;
        frame.attachmentCount = 1;
        frame.pAttachments = &made.view;
        frame.width = extent_.width;
        frame.height = extent_.height;
        frame.layers = 1;
        require(vkCreateFramebuffer(device_, &frame, nullptr, &made.framebuffer), "make a frame");
        VkSemaphoreCreateInfo semaphore{};
        semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
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
    vkGetPhysicalDeviceMemoryProperties(physical_, &properties);
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
        VkBufferCreateInfo buffer{};
        buffer.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        buffer.size = 4 * picture.pixels.size();
        buffer.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        require(vkCreateBuffer(device_, &buffer, nullptr, &staging_), "make a buffer");
        VkImageCreateInfo image{};
        image.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        image.imageType = VK_IMAGE_TYPE_2D;
        image.format = VK_FORMAT_R8G8B8A8_UNORM;
        image.extent = {picture.width, picture.height, 1};
        image.mipLevels = image.arrayLayers = 1;
        image.samples = VK_SAMPLE_COUNT_1_BIT;
        image.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        require(vkCreateImage(device_, &image, nullptr, &picture_), "make an image");
        VkMemoryRequirements needs{};
        VkMemoryAllocateInfo memory{};
        memory.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
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
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
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
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    require(vkBeginCommandBuffer(commands_, &begin), "begin commands");
    record(commands_, images_[index], picture);
    require(vkEndCommandBuffer(commands_), "end commands");
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.waitSemaphoreCount = 1;
    submit.pWaitSemaphores = &is_acquired_;
    submit.pWaitDstStageMask = &stage;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    submit.signalSemaphoreCount = 1;
    submit.pSignalSemaphores = &images_[index].is_drawn;
    require(vkQueueSubmit(queue_, 1, &submit, is_done_), "submit");
    VkPresentInfoKHR present{};
    present.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    present.waitSemaphoreCount = 1;
    present.pWaitSemaphores = &images_[index].is_drawn;
    present.swapchainCount = 1;
    present.pSwapchains = &swapchain_;
    present.pImageIndices = &index;
    const VkResult shown = vkQueuePresentKHR(queue_, &present);
    require(vkWaitForFences(device_, 1, &is_done_, VK_TRUE, UINT64_MAX), "wait for the frame");
    is_out_of_date_ = shown == VK_ERROR_OUT_OF_DATE_KHR || shown == VK_SUBOPTIMAL_KHR || acquired == VK_SUBOPTIMAL_KHR;
    if (!is_out_of_date_) require(shown, "show an image");
    return true;
}

void Screen::wait() const { require(vkDeviceWaitIdle(device_), "wait for the device"); }

}  // namespace twinray::viewer
