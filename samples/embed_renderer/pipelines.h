// SPDX-License-Identifier: MIT
// Pipelines of the renderer: one that rasterises, and kernels.
#pragma once

#include <span>

#include "samples/embed_renderer/targets.h"

namespace twinray::embed_renderer {

// A pipeline with its layout, whose arguments are push constants.
class Pipeline {
  public:
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    template <class Args>
    void bind(VkCommandBuffer commands, const Args& args) const {
        bind_bytes(commands, &args, sizeof args);
    }

  protected:
    // targets: what the shaders read, or null.
    Pipeline(const Device& device, VkPipelineBindPoint point, VkShaderStageFlags stages, std::uint32_t args_bytes,
             const Targets* targets);
    VkShaderModule module_of(std::span<const std::uint32_t> spirv) const;

    const Device& device_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;

  private:
    void bind_bytes(VkCommandBuffer commands, const void* args, std::uint32_t bytes) const;

    VkPipelineBindPoint point_;
    VkShaderStageFlags stages_;
    const Targets* targets_;
};

// Draws triangles without culling, nearest first.
class RasterPipeline : public Pipeline {
  public:
    RasterPipeline(const Device& device, const Targets& targets, std::span<const std::uint32_t> vertex,
                   std::span<const std::uint32_t> fragment, std::uint32_t args_bytes);
};

// targets: what the kernel reads, or null.
class KernelPipeline : public Pipeline {
  public:
    KernelPipeline(const Device& device, std::span<const std::uint32_t> spirv, std::uint32_t args_bytes,
                   const Targets* targets = nullptr);
};

}  // namespace twinray::embed_renderer
