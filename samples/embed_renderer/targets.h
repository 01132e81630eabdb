// SPDX-License-Identifier: MIT
// What the rasteriser draws into, and how kernels read it: a render pass and one descriptor set.
#pragma once

#include "samples/embed_renderer/resources.h"

namespace twinray::embed_renderer {

class Targets {
  public:
    Targets(const Device& device, VkExtent2D size);
    ~Targets();
    Targets(const Targets&) = delete;
    Targets& operator=(const Targets&) = delete;

    VkExtent2D size() const { return size_; }
    VkRenderPass render_pass() const { return render_pass_; }
    static constexpr std::uint32_t color_count = 3;  // base colour, shading normal, ids
    // Clears all targets, the depth to infinity. What is drawn is readable by kernels after end().
    void begin(VkCommandBuffer commands) const;
    void end(VkCommandBuffer commands) const { vkCmdEndRenderPass(commands); }

    // The colour targets as sampled images at bindings 0, 1, 2 of set 0.
    VkDescriptorSetLayout set_layout() const { return set_layout_; }
    VkDescriptorSet set() const { return set_; }

  private:
    void create_render_pass();
    void create_framebuffer();
    void create_set();
    void destroy();

    const Device& device_;
    VkExtent2D size_;
    HostImage colors_[color_count];
    HostImage depth_;
    VkRenderPass render_pass_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace twinray::embed_renderer
