// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/targets.h"

#include <array>

#include "samples/embed_renderer/shared.h"

namespace twinray::embed_renderer {
namespace {

// Formats that every device can render to and sample.
constexpr VkFormat color_formats[] = {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32_UINT};
constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;

VkAttachmentDescription attachment(VkFormat format, VkAttachmentStoreOp store, VkImageLayout layout) {
    VkAttachmentDescription description{};
    description.format = format;
    description.samples = VK_SAMPLE_COUNT_1_BIT;
    description.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    description.storeOp = store;
    description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    description.finalLayout = layout;
    return description;
}

}  // namespace

Targets::Targets(const Device& device, VkExtent2D size) : device_(device), size_(size) {
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    for (std::uint32_t i = 0; i < color_count; ++i) colors_[i] = HostImage(device, color_formats[i], size, usage);
    depth_ = HostImage(device, depth_format, size, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    try {
        create_render_pass();
        create_framebuffer();
        create_set();
    } catch (...) {
        destroy();
        throw;
    }
}

Targets::~Targets() { destroy(); }

void Targets::destroy() {
    vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
    vkDestroyDescriptorSetLayout(device_.handle(), set_layout_, nullptr);
    vkDestroyFramebuffer(device_.handle(), framebuffer_, nullptr);
    vkDestroyRenderPass(device_.handle(), render_pass_, nullptr);
}

void Targets::create_render_pass() {
    std::array<VkAttachmentDescription, color_count + 1> attachments;
    std::array<VkAttachmentReference, color_count> colors;
    for (std::uint32_t i = 0; i < color_count; ++i) {
        attachments[i] =
            attachment(color_formats[i], VK_ATTACHMENT_STORE_OP_STORE, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        colors[i] = {i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    }
    attachments[color_count] =
        attachment(depth_format, VK_ATTACHMENT_STORE_OP_DONT_CARE, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    const VkAttachmentReference depth{color_count, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = color_count;
    subpass.pColorAttachments = colors.data();
    subpass.pDepthStencilAttachment = &depth;

    // Kernels of the last frame have read the targets; those of this one will.
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                         VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                         VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    const VkAccessFlags drawn = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const VkSubpassDependency dependencies[] = {
        {VK_SUBPASS_EXTERNAL, 0, drawing | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, drawing, drawn,
         drawn | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, drawing, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, drawn, VK_ACCESS_SHADER_READ_BIT, 0}};
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = static_cast<std::uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = 2;
    info.pDependencies = dependencies;
    require(vkCreateRenderPass(device_.handle(), &info, nullptr, &render_pass_), "create the render pass");
}

void Targets::create_framebuffer() {
    const VkImageView views[] = {colors_[0].view(), colors_[1].view(), colors_[2].view(), depth_.view()};
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = render_pass_;
    info.attachmentCount = color_count + 1;
    info.pAttachments = views;
    info.width = size_.width;
    info.height = size_.height;
    info.layers = 1;
    require(vkCreateFramebuffer(device_.handle(), &info, nullptr, &framebuffer_), "create the framebuffer");
}

void Targets::create_set() {
    std::array<VkDescriptorSetLayoutBinding, color_count> bindings;
    for (std::uint32_t i = 0; i < color_count; ++i)
        bindings[i] = {i, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    layout.bindingCount = color_count;
    layout.pBindings = bindings.data();
    require(vkCreateDescriptorSetLayout(device_.handle(), &layout, nullptr, &set_layout_), "create a set layout");
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, color_count};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    require(vkCreateDescriptorPool(device_.handle(), &pool, nullptr, &pool_), "create a descriptor pool");
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout_;
    require(vkAllocateDescriptorSets(device_.handle(), &allocate, &set_), "allocate a descriptor set");
    for (std::uint32_t i = 0; i < color_count; ++i) {
        const VkDescriptorImageInfo image{VK_NULL_HANDLE, colors_[i].view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = set_;
        write.dstBinding = i;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
        write.pImageInfo = &image;
        vkUpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
    }
}

void Targets::begin(VkCommandBuffer commands) const {
    VkClearValue clear[color_count + 1] = {};
    clear[2].color.uint32[0] = BACKGROUND;
    clear[color_count].depthStencil.depth = 0;  // infinitely far
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = render_pass_;
    info.framebuffer = framebuffer_;
    info.renderArea.extent = size_;
    info.clearValueCount = color_count + 1;
    info.pClearValues = clear;
    vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{0, 0, static_cast<float>(size_.width), static_cast<float>(size_.height), 0, 1};
    const VkRect2D scissor{{0, 0}, size_};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
}

}  // namespace twinray::embed_renderer
