// SPDX-License-Identifier: MIT
#include "hwtlas/hw_tlas.h"

#include <utility>

#include "engine/core/error.h"
#include "hwtlas/blas.h"
#include "hwtlas_trace_query.spv.h"
#include "hwtlas/pipeline_program.h"

namespace twinray {
namespace {

Context& checked(Context& context) {
    const std::vector<std::string> missing = missing_for_hardware(context.facts());
    if (!missing.empty()) fail("HwTlas: device '", context.facts().name, "' lacks ", joined(missing));
    return context;
}

}  // namespace

struct HwTlas::HwBuiltGeometry : BuiltGeometry {
    explicit HwBuiltGeometry(Blas&& built) : blas(std::move(built)) { bytes = blas.bytes(); }
    Blas blas;
};

struct HwTlas::HwTopLevel : BuiltScene {
    explicit HwTopLevel(Tlas&& built) : tlas(std::move(built)) {
        address = tlas.scene.address();
        bytes = tlas.bytes();
    }
    Tlas tlas;
};

HwTlas::HwTlas(Context& context, BuildOrder order)
    : AbstractAccel(checked(context), "HwTlas"),
      reorder_(order == BuildOrder::morton ||
               (order == BuildOrder::automatic && context.facts().builds_in_input_order)),
      tlas_builder_(context, reorder_) {}

HwTlas::~HwTlas() = default;

Capability HwTlas::capability_on(const DeviceFacts& device, Feature feature) {
    switch (feature) {
        case Feature::deterministic_ties: return {feature, Support::unsupported, "the driver chooses"};
        case Feature::kernel_queries:
            if (device.ray_query) return {feature, Support::native, ""};
            return {feature, Support::unsupported, "the device has no ray queries"};
        case Feature::level_fast:
        case Feature::level_watertight: return {feature, Support::native, "the driver's own test; verify measures it"};
        case Feature::level_refined:
        case Feature::level_certified: return {feature, Support::unsupported, "the driver's test is all there is"};
        case Feature::save_and_load:
            return {feature, Support::unsupported, "the driver's structures stay on its device"};
        default: return {feature, Support::native, ""};
    }
}

std::unique_ptr<TraceProgram> HwTlas::create_program(const TraceProgramCode* code, uint features) const {
    if (!context().facts().ray_query) return std::make_unique<PipelineProgram>(context(), id(), features, code);
    return std::make_unique<KernelProgram>(
        context(), id(), features, code ? code->name : "hwtlas_trace",
        code ? code->ray_query : std::span<const std::uint32_t>(hwtlas_trace_query_spirv));
}

const char* HwTlas::trace_path() const { return context().facts().ray_query ? "ray query" : "ray tracing pipeline"; }

std::vector<std::unique_ptr<AbstractAccel::BuiltGeometry>> HwTlas::build_geometries(
    Commands& commands, std::span<const GeometryInput> inputs) {
    if (inputs.empty()) return {};
    std::vector<const Geometry*> geometries;
    for (const GeometryInput& input : inputs) geometries.push_back(input.geometry);
    std::vector<std::unique_ptr<BuiltGeometry>> built;
    for (Blas& blas : build_blases(commands, geometries, reorder_))
        built.push_back(std::make_unique<HwBuiltGeometry>(std::move(blas)));
    const auto pass = commands.pass("hwtlas geometry blocks");
    for (std::size_t i = 0; i < inputs.size(); ++i)
        commands.write(*inputs[i].block, static_cast<const HwBuiltGeometry&>(*built[i]).blas.block());
    return built;
}

std::unique_ptr<AbstractAccel::BuiltScene> HwTlas::build_scene(Commands& commands, const SceneInput& input,
                                                               const BuiltScene* current) {
    const auto* level = static_cast<const HwTopLevel*>(current);
    std::unique_ptr<HwTopLevel> made;
    const std::size_t capacity = capacity_for(input.count, level ? level->tlas.capacity : 0);
    if (!level || capacity != level->tlas.capacity) {
        made = std::make_unique<HwTopLevel>(tlas_builder_.make(commands, capacity));
        level = made.get();
    }
    tlas_builder_.record_build(commands, level->tlas, {input.records, input.count, input.bound}, input.will_move);
    return made;
}

void HwTlas::refit_scene(Commands& commands, const SceneInput& input, const BuiltScene& current) {
    tlas_builder_.record_update(commands, static_cast<const HwTopLevel&>(current).tlas,
                                {input.records, input.count, input.bound});
}

}  // namespace twinray
