// SPDX-License-Identifier: MIT
#include "hwtlas/hw_tlas.h"

#include <utility>

#include "engine/core/error.h"
#include "hwtlas/blas.h"
#include "hwtlas_trace_query.spv.h"
#include "hwtlas_trace_rchit.spv.h"
#include "hwtlas_trace_rgen.spv.h"
#include "hwtlas_trace_rmiss.spv.h"

namespace twinray {
namespace {

Context& checked(Context& context) {
    const std::vector<std::string> missing = missing_for_hardware(context.facts());
    if (!missing.empty()) fail("HwTlas: device '", context.facts().name, "' lacks ", joined(missing));
    return context;
}

std::size_t index_of(Query query) { return static_cast<std::size_t>(query); }

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
      tlas_builder_(context, reorder_) {
    create_pipelines(Query::closest);
    create_pipelines(Query::any);
}

HwTlas::~HwTlas() = default;

void HwTlas::create_pipelines(Query query) {
    const std::vector<SpecializationConstant> constants = {{HW_HAS_REMAP, reorder_}, {HW_IS_ANY, query == Query::any}};
    if (context().facts().ray_query)
        kernels_[index_of(query)] = std::make_unique<Kernel<HwTraceArgs>>(
            context(),
            KernelDesc{.name = "hwtlas_trace_query", .spirv = hwtlas_trace_query_spirv, .constants = constants});
    else
        pipelines_[index_of(query)] = std::make_unique<RayTracingPipeline>(
            context(), RayTracingPipelineDesc{.name = "hwtlas_trace",
                                              .ray_generation = hwtlas_trace_rgen_spirv,
                                              .miss = hwtlas_trace_rmiss_spirv,
                                              .closest_hit = hwtlas_trace_rchit_spirv,
                                              .constants = constants});
}

const char* HwTlas::trace_path() const {
    return kernels_[index_of(Query::closest)] ? "ray query" : "ray tracing pipeline";
}

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

void HwTlas::record_trace(Commands& commands, const TraceDesc& desc, std::uint64_t scene) const {
    const HwTraceArgs args{
        {scene},   desc.rays,           desc.hits, desc.indirect_count, static_cast<uint>(desc.count),
        desc.mask, flags_of(desc.cull), 0};
    if (const auto& kernel = kernels_[index_of(desc.query)])
        kernel->dispatch(commands, args, desc.count);
    else
        pipelines_[index_of(desc.query)]->trace(commands, args);
}

}  // namespace twinray
