// SPDX-License-Identifier: MIT
#include "hwtlas/ray_tracing_pipeline.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/core/error.h"

namespace twinray {
namespace {

// Every device allows at least 65535 invocations along x; trace.rgen makes one index of x and y.
constexpr std::uint32_t launch_width = 32768;

constexpr VkShaderStageFlags stages =
    VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR | VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR;

// Positions of the groups in the pipeline and of their records in the table.
enum Group : std::uint32_t { ray_generation, miss_group, hit_group, group_count };

VkPhysicalDeviceRayTracingPipelinePropertiesKHR limits_of(const Context& context) {
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR limits{};
    limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &limits;
    context.vk().vkGetPhysicalDeviceProperties2(context.physical_device(), &properties);
    limits.pNext = nullptr;
    return limits;
}

VkRayTracingShaderGroupCreateInfoKHR group_of(std::uint32_t stage, VkRayTracingShaderGroupTypeKHR type) {
    VkRayTracingShaderGroupCreateInfoKHR group{};
    group.sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR;
    group.type = type;
    group.generalShader = group.closestHitShader = group.anyHitShader = group.intersectionShader = VK_SHADER_UNUSED_KHR;
    (type == VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR ? group.generalShader : group.closestHitShader) = stage;
    return group;
}

// The three shader modules; they live until the pipeline has been made from them.
class Modules {
  public:
    Modules(Context& context, const RayTracingPipelineDesc& desc) : context_(context) {
        try {
            modules_[ray_generation] = create_shader_module(context, desc.ray_generation, desc.name + "_rgen");
            modules_[miss_group] = create_shader_module(context, desc.miss, desc.name + "_rmiss");
            modules_[hit_group] = create_shader_module(context, desc.closest_hit, desc.name + "_rchit");
        } catch (...) {
            destroy();
            throw;
        }
    }
    ~Modules() { destroy(); }
    Modules(const Modules&) = delete;
    Modules& operator=(const Modules&) = delete;

    VkShaderModule operator[](Group group) const { return modules_[group]; }

  private:
    void destroy() {
        for (VkShaderModule module : modules_) context_.vk().vkDestroyShaderModule(context_.device(), module, nullptr);
    }
    Context& context_;
    std::array<VkShaderModule, group_count> modules_{};
};

}  // namespace

RayTracingPipeline::RayTracingPipeline(Context& context, const RayTracingPipelineDesc& desc)
    : context_(context), name_(desc.name), limits_(limits_of(context)) {
    layout_ = create_push_constant_layout(context, stages, sizeof(HwTraceArgs));
    try {
        create_pipeline(desc);
        create_shader_binding_table();
    } catch (...) {
        context.vk().vkDestroyPipeline(context.device(), pipeline_, nullptr);
        context.vk().vkDestroyPipelineLayout(context.device(), layout_, nullptr);
        throw;
    }
}

RayTracingPipeline::~RayTracingPipeline() {
    context_.retire([&vk = context_.vk(), device = context_.device(), layout = layout_, pipeline = pipeline_] {
        vk.vkDestroyPipeline(device, pipeline, nullptr);
        vk.vkDestroyPipelineLayout(device, layout, nullptr);
    });
}

void RayTracingPipeline::create_pipeline(const RayTracingPipelineDesc& desc) {
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    for (const SpecializationConstant& constant : desc.constants) {
        entries.push_back({constant.id, static_cast<std::uint32_t>(values.size() * 4), 4});
        values.push_back(constant.value);
    }
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              values.size() * 4, values.data()};
    const Modules modules(context_, desc);
    std::array<VkPipelineShaderStageCreateInfo, group_count> shaders{};
    shaders[ray_generation].stage = VK_SHADER_STAGE_RAYGEN_BIT_KHR;
    shaders[miss_group].stage = VK_SHADER_STAGE_MISS_BIT_KHR;
    shaders[hit_group].stage = VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR;
    for (const Group group : {ray_generation, miss_group, hit_group}) {
        shaders[group].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        shaders[group].module = modules[group];
        shaders[group].pName = "main";
        shaders[group].pSpecializationInfo = &specialization;
    }
    const std::array groups = {group_of(ray_generation, VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR),
                               group_of(miss_group, VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR),
                               group_of(hit_group, VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR)};
    VkRayTracingPipelineCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR;
    info.stageCount = group_count;
    info.pStages = shaders.data();
    info.groupCount = group_count;
    info.pGroups = groups.data();
    info.maxPipelineRayRecursionDepth = 1;
    info.layout = layout_;
    const VkResult result = context_.vk().vkCreateRayTracingPipelinesKHR(
        context_.device(), VK_NULL_HANDLE, context_.pipeline_cache(), 1, &info, nullptr, &pipeline_);
    if (result != VK_SUCCESS) fail("ray tracing pipeline '", name_, "': ", name_of(result));
    context_.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline_), name_);
}

// One record per group, each at the start of a region of its own: regions start at multiples of the base alignment.
void RayTracingPipeline::create_shader_binding_table() {
    const std::uint32_t handle_bytes = limits_.shaderGroupHandleSize;
    const std::uint64_t alignment = std::max(limits_.shaderGroupBaseAlignment, limits_.shaderGroupHandleAlignment);
    record_bytes_ = (handle_bytes + alignment - 1) / alignment * alignment;
    std::vector<std::byte> handles(std::size_t{handle_bytes} * group_count);
    vk_check(context_.vk().vkGetRayTracingShaderGroupHandlesKHR(context_.device(), pipeline_, 0, group_count,
                                                                handles.size(), handles.data()),
             "get the shader group handles");
    table_ = Buffer(context_, {.name = name_ + " shader binding table",
                               .bytes = record_bytes_ * group_count,
                               .memory = Memory::upload,
                               .usage = VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR,
                               .alignment = alignment});
    for (std::size_t group = 0; group < group_count; ++group)
        std::memcpy(table_.mapped() + group * record_bytes_, handles.data() + group * handle_bytes, handle_bytes);
}

void RayTracingPipeline::trace(Commands& commands, const HwTraceArgs& args) const {
    const VulkanFunctions& vk = context_.vk();
    const auto region = [&](Group group) {
        return VkStridedDeviceAddressRegionKHR{table_.address() + group * record_bytes_, record_bytes_, record_bytes_};
    };
    const VkStridedDeviceAddressRegionKHR generation = region(ray_generation), miss = region(miss_group),
                                          hit = region(hit_group), callable{};
    const auto pass = commands.pass(name_);
    vk.vkCmdBindPipeline(commands.handle(), VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline_);
    const std::uint32_t per_launch = limits_.maxRayDispatchInvocationCount / launch_width * launch_width;
    for (std::uint64_t first = 0; first < args.count; first += per_launch) {
        HwTraceArgs part = args;
        part.first = static_cast<uint>(first);
        part.count = static_cast<uint>(std::min<std::uint64_t>(args.count, first + per_launch));
        const std::uint32_t count = part.count - part.first, width = std::min(count, launch_width);
        vk.vkCmdPushConstants(commands.handle(), layout_, stages, 0, sizeof(part), &part);
        vk.vkCmdTraceRaysKHR(commands.handle(), &generation, &miss, &hit, &callable, width, (count + width - 1) / width,
                             1);
    }
}

}  // namespace twinray
