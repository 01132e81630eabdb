// SPDX-License-Identifier: MIT
#include "engine/core/kernel.h"

#include <algorithm>
#include <optional>

#include "engine/core/error.h"

namespace twinray {
namespace {

// vkCmdDispatch guarantees 65535 groups per dimension; larger counts spread over y (global_index() undoes it).
constexpr std::uint64_t groups_per_row = 32768;

VkPipeline new_pipeline(Context& context, const KernelDesc& desc, VkPipelineLayout layout) {
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    for (const SpecializationConstant& constant : desc.constants) {
        entries.push_back({constant.id, static_cast<std::uint32_t>(values.size() * 4), 4});
        values.push_back(constant.value);
    }
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              values.size() * 4, values.data()};
    const VkShaderModule module = create_shader_module(context, desc.spirv, desc.name);
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result =
        context.vk().vkCreateComputePipelines(context.device(), context.pipeline_cache(), 1, &info, nullptr, &pipeline);
    context.vk().vkDestroyShaderModule(context.device(), module, nullptr);
    if (result != VK_SUCCESS) fail("kernel '", desc.name, "': create the pipeline: ", name_of(result));
    return pipeline;
}

}  // namespace

VkShaderModule create_shader_module(Context& context, std::span<const std::uint32_t> spirv, const std::string& name) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    const VkResult result = context.vk().vkCreateShaderModule(context.device(), &info, nullptr, &module);
    if (result != VK_SUCCESS) fail("shader '", name, "': ", name_of(result));
    context.set_name(VK_OBJECT_TYPE_SHADER_MODULE, reinterpret_cast<std::uint64_t>(module), name);
    return module;
}

VkPipelineLayout create_push_constant_layout(Context& context, VkShaderStageFlags stages, std::uint32_t bytes) {
    const VkPushConstantRange range{stages, 0, bytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    vk_check(context.vk().vkCreatePipelineLayout(context.device(), &info, nullptr, &layout),
             "create a pipeline layout");
    return layout;
}

ComputePipeline::ComputePipeline(Context& context, const KernelDesc& desc, std::uint32_t args_bytes)
    : context_(context), desc_(desc), args_bytes_(args_bytes) {
    layout_ = create_push_constant_layout(context, VK_SHADER_STAGE_COMPUTE_BIT, args_bytes);
    if (desc.compiles_when_used) return;
    try {
        compile();
    } catch (...) {
        context.vk().vkDestroyPipelineLayout(context.device(), layout_, nullptr);
        throw;
    }
    desc_.spirv = {};
}

void ComputePipeline::compile() const {
    pipeline_ = new_pipeline(context_, desc_, layout_);
    context_.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline_), desc_.name);
}

ComputePipeline::~ComputePipeline() {
    context_.retire([&vk = context_.vk(), device = context_.device(), layout = layout_, pipeline = pipeline_] {
        vk.vkDestroyPipeline(device, pipeline, nullptr);
        vk.vkDestroyPipelineLayout(device, layout, nullptr);
    });
}

void ComputePipeline::bind(Commands& commands, const void* args) const {
    if (!pipeline_) compile();
    const VulkanFunctions& vk = context_.vk();
    vk.vkCmdBindPipeline(commands.handle(), VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    vk.vkCmdPushConstants(commands.handle(), layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, args_bytes_, args);
}

void ComputePipeline::dispatch_groups(Commands& commands, const void* args, std::uint64_t group_count) const {
    if (group_count == 0) return;
    std::optional<Commands::Pass> own_pass;
    if (!commands.in_pass()) own_pass.emplace(commands, desc_.name);
    bind(commands, args);
    const std::uint64_t rows = (group_count + groups_per_row - 1) / groups_per_row;
    context_.vk().vkCmdDispatch(commands.handle(), static_cast<std::uint32_t>(std::min(group_count, groups_per_row)),
                                static_cast<std::uint32_t>(rows), 1);
}

void ComputePipeline::dispatch_indirect(Commands& commands, const void* args, const Buffer& counts,
                                        std::uint64_t offset) const {
    std::optional<Commands::Pass> own_pass;
    if (!commands.in_pass()) own_pass.emplace(commands, desc_.name);
    bind(commands, args);
    context_.vk().vkCmdDispatchIndirect(commands.handle(), counts.handle(), offset);
}

}  // namespace twinray
