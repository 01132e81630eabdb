// SPDX-License-Identifier: MIT
// The renderer's targets and pipelines. All pipelines take the same push constants: FrameArgs.
#pragma once

#include <span>

#include "device.h"

namespace renderer {

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
