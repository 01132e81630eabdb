#include "hwtlas/ray_tracing_pipeline.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/core/error.h"
#include "engine/core/pipelines.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

// Every device allows at least 65535 invocations along x; trace.glsl makes one index of x and y.
constexpr std::uint32_t launch_width = 32768;

constexpr VkShaderStageFlags stages = VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR |
                                      VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR | VK_SHADER_STAGE_ANY_HIT_BIT_KHR |
                                      VK_SHADER_STAGE_INTERSECTION_BIT_KHR;

// Positions of the groups in the pipeline and of their records in the table. The last two are hit records: the
// instance's GEOMETRY_TRIANGLES or GEOMETRY_BOXES, which shaders/hwtlas/instances.comp writes, chooses one.
enum Group : std::uint32_t { ray_generation, miss_group, triangle_group, box_group, group_count };

VkPhysicalDeviceRayTracingPipelinePropertiesKHR limits_of(const Context& context) {
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR limits{};
    limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &limits;
    context.state().vk().vkGetPhysicalDeviceProperties2(context.physical_device(), &properties);
    limits.pNext = nullptr;
    return limits;
}

// The shader stages of a pipeline; their modules live until the pipeline has been made from them.
class Stages {
  public:
    Stages(Context& context, std::span<const SpecializationConstant> constants)
        : context_(context), constants_(constants) {}
    ~Stages() {
        for (const VkPipelineShaderStageCreateInfo& stage : stages_)
            context_.state().vk().vkDestroyShaderModule(context_.device(), stage.module, nullptr);
    }
    Stages(const Stages&) = delete;
    Stages& operator=(const Stages&) = delete;

    // Returns its index, for use in groups; VK_SHADER_UNUSED_KHR for no code.
    std::uint32_t add(VkShaderStageFlagBits stage, std::span<const std::uint32_t> spirv, const std::string& name) {
        if (spirv.empty()) return VK_SHADER_UNUSED_KHR;
        stages_.reserve(stages_.size() + 1);
        VkPipelineShaderStageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage = stage;
        info.module = create_shader_module(context_, spirv, constants_, name);
        info.pName = "main";
        stages_.push_back(info);
        return static_cast<std::uint32_t>(stages_.size() - 1);
    }
    std::span<const VkPipelineShaderStageCreateInfo> all() const { return stages_; }

  private:
    Context& context_;
    std::span<const SpecializationConstant> constants_;
    std::vector<VkPipelineShaderStageCreateInfo> stages_;
};

VkRayTracingShaderGroupCreateInfoKHR general_group(std::uint32_t stage) {
    return {VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
            nullptr,
            VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR,
            stage,
            VK_SHADER_UNUSED_KHR,
            VK_SHADER_UNUSED_KHR,
            VK_SHADER_UNUSED_KHR,
            nullptr};
}

// The group is for triangles unless there is an intersection shader.
VkRayTracingShaderGroupCreateInfoKHR hit_group(std::uint32_t closest_hit, std::uint32_t any_hit,
                                               std::uint32_t intersection) {
    return {VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
            nullptr,
            intersection == VK_SHADER_UNUSED_KHR ? VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR
                                                 : VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR,
            VK_SHADER_UNUSED_KHR,
            closest_hit,
            any_hit,
            intersection,
            nullptr};
}

}  // namespace

RayTracingPipeline::RayTracingPipeline(Context& context, const RayTracingPipelineDesc& desc)
    : context_(context),
      name_(desc.name),
      limits_(limits_of(context)),
      launch_limit_(std::min(limits_.maxRayDispatchInvocationCount, desc.launch_limit)),
      addresses_(kernel_addresses(desc.ray_generation)) {
    layout_ = create_push_constant_layout(context, stages, sizeof(TraceArgs));
    try {
        create_pipeline(desc);
        create_shader_binding_table();
    } catch (...) {
        context.state().vk().vkDestroyPipeline(context.device(), pipeline_, nullptr);
        context.state().vk().vkDestroyPipelineLayout(context.device(), layout_, nullptr);
        throw;
    }
}

RayTracingPipeline::~RayTracingPipeline() {
    context_.state().retire(
        [&vk = context_.state().vk(), device = context_.device(), layout = layout_, pipeline = pipeline_] {
            vk.vkDestroyPipeline(device, pipeline, nullptr);
            vk.vkDestroyPipelineLayout(device, layout, nullptr);
        });
}

void RayTracingPipeline::create_pipeline(const RayTracingPipelineDesc& desc) {
    Stages shaders(context_, desc.constants);
    const std::uint32_t generation = shaders.add(VK_SHADER_STAGE_RAYGEN_BIT_KHR, desc.ray_generation, name_ + " rgen");
    const std::uint32_t miss = shaders.add(VK_SHADER_STAGE_MISS_BIT_KHR, desc.miss, name_ + " rmiss");
    const std::uint32_t closest = shaders.add(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, desc.closest_hit, name_ + " rchit");
    const std::uint32_t any = shaders.add(VK_SHADER_STAGE_ANY_HIT_BIT_KHR, desc.any_hit, name_ + " rahit");
    const std::uint32_t box = shaders.add(VK_SHADER_STAGE_INTERSECTION_BIT_KHR, desc.intersection, name_ + " rint");
    const std::span<const VkPipelineShaderStageCreateInfo> modules = shaders.all();
    const std::array<VkRayTracingShaderGroupCreateInfoKHR, group_count> groups = {
        general_group(generation), general_group(miss), hit_group(closest, any, VK_SHADER_UNUSED_KHR),
        hit_group(closest, any, box)};
    VkRayTracingPipelineCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR;
    info.stageCount = static_cast<std::uint32_t>(modules.size());
    info.pStages = modules.data();
    info.groupCount = group_count;
    info.pGroups = groups.data();
    info.maxPipelineRayRecursionDepth = 1;
    info.layout = layout_;
    const VkResult result = context_.state().vk().vkCreateRayTracingPipelinesKHR(
        context_.device(), VK_NULL_HANDLE, context_.state().pipeline_cache(), 1, &info, nullptr, &pipeline_);
    if (result != VK_SUCCESS) fail("ray tracing pipeline '", name_, "': ", name_of(result));
    context_.state().set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline_), name_);
}

// There is one record per group, each at a multiple of the base alignment, where regions may start; the hit records are
// one region.
void RayTracingPipeline::create_shader_binding_table() {
    const std::uint32_t handle_bytes = limits_.shaderGroupHandleSize;
    const std::uint64_t alignment = std::max(limits_.shaderGroupBaseAlignment, limits_.shaderGroupHandleAlignment);
    record_bytes_ = (handle_bytes + alignment - 1) / alignment * alignment;
    std::vector<std::byte> handles(std::size_t{handle_bytes} * group_count);
    vk_check(context_.state().vk().vkGetRayTracingShaderGroupHandlesKHR(context_.device(), pipeline_, 0, group_count,
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

void RayTracingPipeline::trace(Commands& commands, const TraceArgs& args) const {
    const VulkanTable& vk = context_.state().vk();
    const auto region = [&](Group group) {
        return VkStridedDeviceAddressRegionKHR{table_.address() + group * record_bytes_, record_bytes_, record_bytes_};
    };
    const VkStridedDeviceAddressRegionKHR generation = region(ray_generation), miss = region(miss_group), callable{};
    VkStridedDeviceAddressRegionKHR hit = region(triangle_group);
    hit.size = 2 * record_bytes_;
    const auto pass = commands.pass(name_);
    vk.vkCmdBindPipeline(commands.handle(), VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline_);
    // Launches consist of whole rows; a device's limit is at least 2^30.
    const std::uint32_t per_launch = std::max(launch_limit_ / launch_width, 1u) * launch_width;
    for (std::uint64_t first = 0; first < args.count; first += per_launch) {
        TraceArgs part = args;
        part.first = static_cast<uint>(first);
        part.count = static_cast<uint>(std::min<std::uint64_t>(args.count, first + per_launch));
        const std::uint32_t count = part.count - part.first, width = std::min(count, launch_width);
        const std::vector<std::byte> readable =
            readable_args(context_, name_, addresses_, std::as_bytes(std::span(&part, 1)));
        vk.vkCmdPushConstants(commands.handle(), layout_, stages, 0, sizeof(part), readable.data());
        vk.vkCmdTraceRaysKHR(commands.handle(), &generation, &miss, &hit, &callable, width, (count + width - 1) / width,
                             1);
    }
}

}  // namespace twinray
