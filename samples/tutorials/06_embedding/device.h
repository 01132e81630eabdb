// SPDX-License-Identifier: MIT
// The renderer's own Vulkan: instance, device, queue, which twinray uses as a guest; buffers and images, each with
// memory of its own; targets and pipelines. All pipelines take the same push constants: FrameArgs.
#pragma once

#include <vulkan/vulkan.h>

#include <functional>
#include <span>

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

// A buffer that shaders reach by its address. Move-only.
class Buffer {
  public:
    enum class Place { device, host };  // host: mapped, coherent
    Buffer() = default;
    // more_usage: further usage beyond storage, transfer and device address.
    Buffer(const Device& device, VkDeviceSize bytes, Place place = Place::device, VkBufferUsageFlags more_usage = 0);
    ~Buffer();
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept;

    VkBuffer handle() const { return handle_; }
    VkDeviceSize bytes() const { return bytes_; }
    VkDeviceAddress address() const { return address_; }
    void* mapped() const { return mapped_; }

  private:
    const Device* device_ = nullptr;
    VkBuffer handle_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize bytes_ = 0;
    VkDeviceAddress address_ = 0;
    void* mapped_ = nullptr;
};

// Returns a buffer in the device's memory with the data; waits for the upload.
Buffer uploaded(const Device& device, std::span<const std::byte> data);

// A render target. Not copied.
struct Image {
    Image(const Device& owner, VkFormat format, VkExtent2D size, VkImageUsageFlags usage, VkImageAspectFlags aspect);
    ~Image();
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;

    const Device& device;
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
};

using Spirv = std::span<const std::uint32_t>;

// The arguments of all shaders, as scene.glsl declares them. Addresses of device memory.
struct FrameArgs {
    VkDeviceAddress bodies = 0, ids = 0, rays = 0, hits = 0, colors = 0;
    float eye[3] = {}, forward[3] = {}, right[3] = {}, up[3] = {};
    std::uint32_t width = 0, height = 0;
    std::uint32_t rays_per_pixel = 0;  // 0: nothing is traced
    std::uint32_t reserved = 0;
};
static_assert(sizeof(FrameArgs) <= 128);

// Stores for each pixel the visible triangle and its body, and the depth that decides it.
class Targets {
  public:
    Targets(const Device& device, VkExtent2D size);
    ~Targets();
    Targets(const Targets&) = delete;
    Targets& operator=(const Targets&) = delete;

    VkExtent2D size() const { return size_; }
    VkRenderPass render_pass() const { return render_pass_; }
    void begin(VkCommandBuffer commands) const;
    // Ends the render pass; copies the visible triangles into `ids`, for kernels.
    void end(VkCommandBuffer commands, const Buffer& ids) const;

  private:
    void create_render_pass();
    void create_framebuffer();

    const Device& device_;
    VkExtent2D size_;
    Image ids_, depth_;
    VkRenderPass render_pass_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

// A pipeline with its layout.
class Pipeline {
  public:
    // Makes one that draws triangles.
    Pipeline(const Device& device, const Targets& targets, Spirv vertex, Spirv fragment);
    // Makes a kernel.
    Pipeline(const Device& device, Spirv compute);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    void bind(VkCommandBuffer commands, const FrameArgs& args) const;

  private:
    Pipeline(const Device& device, VkPipelineBindPoint point, VkShaderStageFlags stages);

    const Device& device_;
    VkPipelineBindPoint point_;
    VkShaderStageFlags stages_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace renderer
