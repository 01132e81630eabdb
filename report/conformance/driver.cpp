#include "report/conformance/driver.h"

#include <algorithm>
#include <cstring>

#include "conformance_pipeline_rahit.spv.h"
#include "conformance_pipeline_rchit.spv.h"
#include "conformance_pipeline_rgen.spv.h"
#include "conformance_pipeline_rgen_culling.spv.h"
#include "conformance_pipeline_rint.spv.h"
#include "conformance_pipeline_rmiss.spv.h"
#include "conformance_query.spv.h"
#include "conformance_query_culling.spv.h"
#include "engine/core/error.h"
#include "engine/core/commands.h"
#include "engine/core/vulkan.h"

namespace twinray::conformance {
namespace {

KernelDesc query_desc(const Context& context) {
    if (!context.properties().ray_query) fail("the conformance suite needs VK_KHR_ray_query");
    KernelDesc desc{.name = "conformance_query", .spirv = conformance_query_spirv};
    if (context.properties().primitive_culling) desc.spirv = conformance_query_culling_spirv;
    return desc;
}

RayTracingPipelineDesc pipeline_desc(const Context& context) {
    RayTracingPipelineDesc desc;
    desc.name = "conformance_pipeline";
    desc.ray_generation = conformance_pipeline_rgen_spirv;
    if (context.properties().primitive_culling) desc.ray_generation = conformance_pipeline_rgen_culling_spirv;
    desc.miss = conformance_pipeline_rmiss_spirv;
    desc.closest_hit = conformance_pipeline_rchit_spirv;
    desc.any_hit = conformance_pipeline_rahit_spirv;
    desc.intersection = conformance_pipeline_rint_spirv;
    return desc;
}

// Opens passes. Sets the answers to zero first.
void record_trace(const RayTracingPipeline& pipeline, Commands& commands, const QueryArgs& args,
                  const Buffer& answers) {
    Buffer arguments(commands.context(), {.name = "conformance arguments", .bytes = sizeof(QueryArgs)});
    {
        const auto pass = commands.pass("conformance arguments");
        commands.write(arguments, args);
        commands.fill(answers, 0, answers.bytes(), 0);
    }
    TraceArgs launch{};
    launch.user_data = arguments.address();
    launch.count = args.count;
    pipeline.trace(commands, launch);
    commands.retain(std::move(arguments));
}

VkAccelerationStructureBuildGeometryInfoKHR build_info(const BuildInput& input) {
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    info.type = input.type;
    info.flags = input.flags;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = static_cast<std::uint32_t>(input.geometries.size());
    info.pGeometries = input.geometries.data();
    return info;
}

VkAccelerationStructureBuildSizesInfoKHR sizes_of(const Context& context, const BuildInput& input) {
    const VkAccelerationStructureBuildGeometryInfoKHR info = build_info(input);
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    context.state().vk().vkGetAccelerationStructureBuildSizesKHR(
        context.device(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, input.counts.data(), &sizes);
    return sizes;
}

BottomInput spoiled(Misdeed misdeed, BottomInput input) {
    spoil(misdeed, input);
    return input;
}

// Adds the record offsets, which the stages of a pipeline do not know.
void add_record_offsets(const Top& top, Traced& traced) {
    for (Answer& answer : traced.answers)
        if (answer.kind != ANSWER_MISS && answer.instance < top.input.instances.size())
            answer.sbt_offset = top.input.instances[answer.instance].sbt_offset;
}

}  // namespace

std::uint64_t Serialized::word(std::size_t index) const {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + header_bytes + index * sizeof value, sizeof value);
    return value;
}

std::span<const std::uint8_t, VK_UUID_SIZE> Serialized::driver_uuid() const {
    return std::span<const std::uint8_t, VK_UUID_SIZE>(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                                       VK_UUID_SIZE);
}

std::vector<std::uint64_t> Serialized::handles() const {
    std::vector<std::uint64_t> addresses;
    for (std::size_t i = 0; i < handle_count(); ++i) addresses.push_back(word(3 + i));
    return addresses;
}

void Serialized::set_handles(std::span<const std::uint64_t> addresses) {
    std::memcpy(bytes.data() + header_bytes + 3 * sizeof(std::uint64_t), addresses.data(), addresses.size_bytes());
}

BottomRef Bottom::ref() const {
    const bool holds_boxes = std::ranges::any_of(input.geometries, &GeometryInput::is_boxes);
    return {structure.address(), holds_boxes};
}

Driver::Driver(Context& context, Backend way) : context_(context) {
    if (way == Backend::ray_query)
        query_ = std::make_unique<Kernel<QueryArgs>>(context, query_desc(context));
    else
        pipeline_ = std::make_unique<RayTracingPipeline>(context, pipeline_desc(context));
}

TopInput Driver::told(const TopInput& input, const std::vector<BottomRef>& bottoms) const {
    TopInput told = input;
    spoil(misdeed_, told);
    if (!pipeline_) return told;
    for (InstanceInput& instance : told.instances)
        instance.sbt_offset = instance.bottom != no_bottom && bottoms[instance.bottom].holds_boxes ? 1 : 0;
    return told;
}

AccelerationStructure Driver::new_structure(const char* name, const BuildInput& input) {
    return {context_, name, input.type, sizes_of(context_, input).accelerationStructureSize};
}

void Driver::record_build(Commands& commands, std::span<const BuildInput> inputs,
                          std::span<const AccelerationStructure* const> targets,
                          const AccelerationStructure* updated_from) {
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const VkAccelerationStructureBuildSizesInfoKHR sizes = sizes_of(context_, inputs[i]);
        const std::uint64_t bytes = updated_from ? sizes.updateScratchSize : sizes.buildScratchSize;
        Buffer scratch = make_build_scratch(context_, "conformance scratch", std::max<std::uint64_t>(bytes, 1));
        VkAccelerationStructureBuildGeometryInfoKHR& info = infos.emplace_back(build_info(inputs[i]));
        info.dstAccelerationStructure = targets[i]->handle();
        info.scratchData.deviceAddress = scratch.address();
        if (updated_from) {
            info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
            info.srcAccelerationStructure = updated_from->handle();
        }
        ranges.push_back(inputs[i].ranges.data());
        commands.retain(std::move(scratch));
    }
    const auto pass = commands.pass("conformance build");
    context_.state().vk().vkCmdBuildAccelerationStructuresKHR(
        commands.handle(), static_cast<std::uint32_t>(infos.size()), infos.data(), ranges.data());
}

void Driver::submit_build(Commands& commands, const BuildInput& input, const AccelerationStructure& target,
                          const AccelerationStructure* updated_from) {
    const AccelerationStructure* const structure = &target;
    record_build(commands, std::span(&input, 1), std::span(&structure, 1), updated_from);
    commands.submit();
}

Bottom Driver::build(const BottomInput& input) { return std::move(build_together(std::span(&input, 1)).front()); }

std::vector<Bottom> Driver::build_together(std::span<const BottomInput> inputs) {
    Commands commands(context_, "conformance bottom levels");
    std::vector<Bottom> bottoms;
    std::vector<BuildInput> uploaded;
    std::vector<const AccelerationStructure*> targets;
    bottoms.reserve(inputs.size());
    for (const BottomInput& input : inputs) {
        uploaded.push_back(upload(commands, spoiled(misdeed_, input)));
        bottoms.push_back({new_structure("conformance bottom level", uploaded.back()), input});
        targets.push_back(&bottoms.back().structure);
    }
    record_build(commands, uploaded, targets);
    commands.submit();
    return bottoms;
}

Top Driver::build(const TopInput& input, std::span<const Bottom> bottoms) {
    std::vector<BottomRef> refs;
    for (const Bottom& bottom : bottoms) refs.push_back(bottom.ref());
    return build(input, refs);
}

Top Driver::build(const TopInput& input, const std::vector<BottomRef>& bottoms) {
    Commands commands(context_, "conformance top level");
    const BuildInput uploaded = upload(commands, told(input, bottoms), bottoms);
    Top top{new_structure("conformance top level", uploaded), input, bottoms};
    submit_build(commands, uploaded, top.structure);
    return top;
}

DriverScene Driver::build(const SceneInput& scene) {
    DriverScene built;
    for (const BottomInput& bottom : scene.bottoms) built.bottoms.push_back(build(bottom));
    built.top = build(scene.top, built.bottoms);
    return built;
}

void Driver::rebuild(Bottom& bottom, const BottomInput& input, const char* name, bool is_update) {
    if (misdeed_ == Misdeed::forgets_updates) return;
    Commands commands(context_, name);
    const BuildInput uploaded = upload(commands, spoiled(misdeed_, input));
    submit_build(commands, uploaded, bottom.structure, is_update ? &bottom.structure : nullptr);
    bottom.input = input;
}

void Driver::update(Top& top, const TopInput& input) {
    if (misdeed_ == Misdeed::forgets_updates) return;
    Commands commands(context_, "conformance update of a top level");
    const BuildInput uploaded = upload(commands, told(input, top.bottoms), top.bottoms);
    submit_build(commands, uploaded, top.structure, &top.structure);
    top.input = input;
}

Bottom Driver::updated(const Bottom& source, const BottomInput& input) {
    if (misdeed_ == Misdeed::forgets_updates) return copied(source, Copy::clone);
    Commands commands(context_, "conformance update into another");
    const BuildInput uploaded = upload(commands, spoiled(misdeed_, input));
    Bottom updated{new_structure("conformance updated", uploaded), input};
    submit_build(commands, uploaded, updated.structure, &source.structure);
    return updated;
}

Traced Driver::trace(const Top& top, std::span<const Shot> given, uint slots) {
    std::vector<Shot> shots(given.begin(), given.end());
    spoil(misdeed_, shots);
    const Buffer from = uploaded(context_, "conformance shots", std::span<const Shot>(shots));
    const Buffer answers(context_, {.name = "conformance answers", .bytes = shots.size() * sizeof(Answer)});
    const Buffer candidates(context_, {.name = "conformance candidates", .bytes = shots.size() * slots * sizeof(uint)});
    Commands commands(context_, "conformance trace");
    const QueryArgs args{.structure = top.structure.address(),
                         .shots = from.ref<Shot>(),
                         .answers = answers.ref<Answer>(),
                         .candidates = candidates.ref<uint>(),
                         .count = static_cast<uint>(shots.size()),
                         .slots = slots};
    if (query_)
        query_->dispatch(commands, args, shots.size());
    else
        record_trace(*pipeline_, commands, args, answers);
    commands.submit();
    Traced traced{download<Answer>(context_, answers, shots.size()),
                  download<uint>(context_, candidates, shots.size() * slots), slots};
    if (pipeline_) add_record_offsets(top, traced);
    spoil(misdeed_, traced, traces_++);
    return traced;
}

}  // namespace twinray::conformance
