// SPDX-License-Identifier: MIT
#include "device.h"

namespace renderer {
namespace {

VkShaderModule module_of(const Device& device, Spirv spirv) {
    auto info = of_type<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    require(vkCreateShaderModule(device.handle(), &info, nullptr, &module), "create a shader module");
    return module;
}

VkPipelineShaderStageCreateInfo stage_of(VkShaderStageFlagBits stage, VkShaderModule module) {
    auto info = of_type<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    return info;
}

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

Pipeline::Pipeline(const Device& device, VkPipelineBindPoint point, VkShaderStageFlags stages)
    : device_(device), point_(point), stages_(stages) {
    const VkPushConstantRange range{stages, 0, sizeof(FrameArgs)};
    auto info = of_type<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    require(vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout_), "create a pipeline layout");
}

// There is no vertex input: the vertex shader reads its data by address. Depth is 1 nearby and 0 far away.
Pipeline::Pipeline(const Device& device, const Targets& targets, Spirv vertex, Spirv fragment)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_GRAPHICS, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT) {
    const VkPipelineShaderStageCreateInfo stages[] = {
        stage_of(VK_SHADER_STAGE_VERTEX_BIT, module_of(device, vertex)),
        stage_of(VK_SHADER_STAGE_FRAGMENT_BIT, module_of(device, fragment))};
    const auto input =
        of_type<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    auto assembly =
        of_type<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkExtent2D size = targets.size();
    const VkViewport all{0, 0, static_cast<float>(size.width), static_cast<float>(size.height), 0, 1};
    const VkRect2D scissor{{0, 0}, size};
    auto viewport = of_type<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = viewport.scissorCount = 1;
    viewport.pViewports = &all;
    viewport.pScissors = &scissor;
    auto raster =
        of_type<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.lineWidth = 1;
    auto samples =
        of_type<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    auto depth =
        of_type<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER;
    VkPipelineColorBlendAttachmentState written{};
    written.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT;
    auto blend = of_type<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    blend.attachmentCount = 1;
    blend.pAttachments = &written;

    auto info = of_type<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.layout = layout_;
    info.renderPass = targets.render_pass();
    const VkResult result = vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    for (const auto& stage : stages) vkDestroyShaderModule(device.handle(), stage.module, nullptr);
    require(result, "create the raster pipeline");
}

Pipeline::Pipeline(const Device& device, Spirv compute)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_COMPUTE, VK_SHADER_STAGE_COMPUTE_BIT) {
    auto info = of_type<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = stage_of(VK_SHADER_STAGE_COMPUTE_BIT, module_of(device, compute));
    info.layout = layout_;
    const VkResult result = vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    vkDestroyShaderModule(device.handle(), info.stage.module, nullptr);
    require(result, "create a kernel");
}

Pipeline::~Pipeline() {
    vkDestroyPipeline(device_.handle(), pipeline_, nullptr);
    vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
}

void Pipeline::bind(VkCommandBuffer commands, const FrameArgs& args) const {
    vkCmdBindPipeline(commands, point_, pipeline_);
    vkCmdPushConstants(commands, layout_, stages_, 0, sizeof args, &args);
}

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
