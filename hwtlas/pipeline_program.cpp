// SPDX-License-Identifier: MIT
#include "hwtlas/pipeline_program.h"

#include "hwtlas_trace_rchit.spv.h"
#include "hwtlas_trace_rgen.spv.h"
#include "hwtlas_trace_rgen_refined.spv.h"
#include "hwtlas_trace_rmiss.spv.h"

namespace twinray {

PipelineProgram::PipelineProgram(Context& context, std::uint64_t accel, uint features, const TraceProgramCode* code)
    : TraceProgram(accel, features, code ? code->name : "hwtlas_trace"), context_(context) {
    if (code && features & FEATURE_FILTERS) any_hit_ = code->any_hit;
    if (code && features & FEATURE_BOXES) intersection_ = code->intersection;
}

void PipelineProgram::prepare(Query query, Level level) const { pipeline(query, level); }

void PipelineProgram::record(Commands& commands, const TraceArgs& args, Query query, Level level) const {
    pipeline(query, level).trace(commands, args);
}

const RayTracingPipeline& PipelineProgram::pipeline(Query query, Level level) const {
    const bool refines = level >= Level::refined;
    std::unique_ptr<RayTracingPipeline>& pipeline = pipelines_[static_cast<std::size_t>(query)][refines];
    if (!pipeline)
        pipeline = std::make_unique<RayTracingPipeline>(
            context_, RayTracingPipelineDesc{
                          .name = name() + (query == Query::any ? " any" : " closest"),
                          .ray_generation = refines ? std::span<const std::uint32_t>(hwtlas_trace_rgen_refined_spirv)
                                                    : std::span<const std::uint32_t>(hwtlas_trace_rgen_spirv),
                          .miss = hwtlas_trace_rmiss_spirv,
                          .closest_hit = hwtlas_trace_rchit_spirv,
                          .any_hit = any_hit_,
                          .intersection = intersection_,
                          .constants = {{QUERY_CONSTANT, query == Query::any ? QUERY_ANY : QUERY_CLOSEST},
                                        {FEATURES_CONSTANT, features()}}});
    return *pipeline;
}

}  // namespace twinray
