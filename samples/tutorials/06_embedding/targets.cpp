// SPDX-License-Identifier: MIT
#include "pipelines.h"

namespace renderer {
namespace {

constexpr VkFormat ids_format = VK_FORMAT_R32G32_UINT, depth_format = VK_FORMAT_D32_SFLOAT;

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

Targets::Targets(const Device& device, VkExtent2D size)
    : device_(device),
      size_(size),
      ids_(device, ids_format, size, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
           VK_IMAGE_ASPECT_COLOR_BIT),
      depth_(device, depth_format, size, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT) {
    create_render_pass();
    create_framebuffer();
}

Targets::~Targets() {
    vkDestroyFramebuffer(device_.handle(), framebuffer_, nullptr);
    vkDestroyRenderPass(device_.handle(), render_pass_, nullptr);
}

void Targets::create_render_pass() {
    const VkAttachmentDescription attachments[] = {
        attachment(ids_format, VK_ATTACHMENT_STORE_OP_STORE, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
        attachment(depth_format, VK_ATTACHMENT_STORE_OP_DONT_CARE, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL)};
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    subpass.pDepthStencilAttachment = &depth;
    // The last frame has copied its targets before this one draws; this one's are copied after it.
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                         VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                         VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    const VkAccessFlags drawn = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const VkSubpassDependency dependencies[] = {
        {VK_SUBPASS_EXTERNAL, 0, drawing | VK_PIPELINE_STAGE_TRANSFER_BIT, drawing, drawn,
         drawn | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, drawing, VK_PIPELINE_STAGE_TRANSFER_BIT, drawn, VK_ACCESS_TRANSFER_READ_BIT, 0}};
    auto info = of_type<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    info.attachmentCount = 2;
    info.pAttachments = attachments;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = 2;
    info.pDependencies = dependencies;
    require(vkCreateRenderPass(device_.handle(), &info, nullptr, &render_pass_), "create the render pass");
}

void Targets::create_framebuffer() {
    const VkImageView views[] = {ids_.view, depth_.view};
    auto info = of_type<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    info.renderPass = render_pass_;
    info.attachmentCount = 2;
    info.pAttachments = views;
    info.width = size_.width;
    info.height = size_.height;
    info.layers = 1;
    require(vkCreateFramebuffer(device_.handle(), &info, nullptr, &framebuffer_), "create the framebuffer");
}

void Targets::begin(VkCommandBuffer commands) const {
    VkClearValue clear[2] = {};
    clear[0].color.uint32[0] = ~0u;  // no body
    clear[1].depthStencil.depth = 0;
    auto info = of_type<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    info.renderPass = render_pass_;
    info.framebuffer = framebuffer_;
    info.renderArea.extent = size_;
    info.clearValueCount = 2;
    info.pClearValues = clear;
    vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
}

void Targets::end(VkCommandBuffer commands, const Buffer& ids) const {
    vkCmdEndRenderPass(commands);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {size_.width, size_.height, 1};
    vkCmdCopyImageToBuffer(commands, ids_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, ids.handle(), 1, &region);
}

}  // namespace renderer
