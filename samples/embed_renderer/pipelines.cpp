// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/pipelines.h"

#include <array>

namespace twinray::embed_renderer {
namespace {

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, VkShaderModule module) {
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = which;
    info.module = module;
    info.pName = "main";
    return info;
}

// The fixed functions: triangles of vertices that are fetched by address, one sample a pixel, depth as near / z.
struct RasterState {
    RasterState() {
        input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
        assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
        viewport.viewportCount = viewport.scissorCount = 1;
        rasterization.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
        rasterization.lineWidth = 1;
        multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
        multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
        depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
        depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
        depth.depthCompareOp = VK_COMPARE_OP_GREATER;
        for (auto& attachment : attachments)
            attachment.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT |
                                        VK_COLOR_COMPONENT_A_BIT;
        blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
        blend.attachmentCount = Targets::color_count;
        blend.pAttachments = attachments.data();
        dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
        dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
        dynamic.pDynamicStates = dynamic_states.data();
    }
    RasterState(const RasterState&) = delete;
    RasterState& operator=(const RasterState&) = delete;

    VkPipelineVertexInputStateCreateInfo input{};
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    VkPipelineViewportStateCreateInfo viewport{};
    VkPipelineRasterizationStateCreateInfo rasterization{};
    VkPipelineMultisampleStateCreateInfo multisample{};
    VkPipelineDepthStencilStateCreateInfo depth{};
    std::array<VkPipelineColorBlendAttachmentState, Targets::color_count> attachments{};
    VkPipelineColorBlendStateCreateInfo blend{};
    std::array<VkDynamicState, 2> dynamic_states = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};
};

}  // namespace

Pipeline::Pipeline(const Device& device, VkPipelineBindPoint point, VkShaderStageFlags stages, std::uint32_t args_bytes,
                   const Targets* targets)
    : device_(device), point_(point), stages_(stages), targets_(targets) {
    const VkPushConstantRange range{stages, 0, args_bytes};
    const VkDescriptorSetLayout set_layout = targets ? targets->set_layout() : VK_NULL_HANDLE;
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = targets ? 1 : 0;
    info.pSetLayouts = &set_layout;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    require(vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout_), "create a pipeline layout");
}

Pipeline::~Pipeline() {
    vkDestroyPipeline(device_.handle(), pipeline_, nullptr);
    vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
}

VkShaderModule Pipeline::module_of(std::span<const std::uint32_t> spirv) const {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    require(vkCreateShaderModule(device_.handle(), &info, nullptr, &module), "create a shader module");
    return module;
}

void Pipeline::bind_bytes(VkCommandBuffer commands, const void* args, std::uint32_t bytes) const {
    vkCmdBindPipeline(commands, point_, pipeline_);
    vkCmdPushConstants(commands, layout_, stages_, 0, bytes, args);
    if (!targets_) return;
    const VkDescriptorSet set = targets_->set();
    vkCmdBindDescriptorSets(commands, point_, layout_, 0, 1, &set, 0, nullptr);
}

RasterPipeline::RasterPipeline(const Device& device, const Targets& targets, std::span<const std::uint32_t> vertex,
                               std::span<const std::uint32_t> fragment, std::uint32_t args_bytes)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_GRAPHICS, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
               args_bytes, nullptr) {
    const VkShaderModule modules[] = {module_of(vertex), module_of(fragment)};
    const VkPipelineShaderStageCreateInfo stages[] = {stage(VK_SHADER_STAGE_VERTEX_BIT, modules[0]),
                                                      stage(VK_SHADER_STAGE_FRAGMENT_BIT, modules[1])};
    const RasterState state;
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &state.input;
    info.pInputAssemblyState = &state.assembly;
    info.pViewportState = &state.viewport;
    info.pRasterizationState = &state.rasterization;
    info.pMultisampleState = &state.multisample;
    info.pDepthStencilState = &state.depth;
    info.pColorBlendState = &state.blend;
    info.pDynamicState = &state.dynamic;
    info.layout = layout_;
    info.renderPass = targets.render_pass();
    const VkResult result = vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    for (VkShaderModule module : modules) vkDestroyShaderModule(device.handle(), module, nullptr);
    require(result, "create the raster pipeline");
}

KernelPipeline::KernelPipeline(const Device& device, std::span<const std::uint32_t> spirv, std::uint32_t args_bytes,
                               const Targets* targets)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_COMPUTE, VK_SHADER_STAGE_COMPUTE_BIT, args_bytes, targets) {
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, module_of(spirv));
    info.layout = layout_;
    const VkResult result = vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    vkDestroyShaderModule(device.handle(), info.stage.module, nullptr);
    require(result, "create a kernel");
}

}  // namespace twinray::embed_renderer
