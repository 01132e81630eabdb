// SPDX-License-Identifier: MIT
// Tracing batches through a ray tracing pipeline.
#pragma once

#include "engine/accel/trace_program.h"
#include "hwtlas/ray_tracing_pipeline.h"

namespace twinray {

// One pipeline for each query, and one each that refines.
class PipelineProgram final : public TraceProgram {
  public:
    // code: null for scenes that need no program.
    PipelineProgram(Context& context, std::uint64_t accel, uint features, const TraceProgramCode* code);
    void prepare(Query query, Level level) const override;
    void record(Commands& commands, const TraceArgs& args, Query query, Level level) const override;

  private:
    const RayTracingPipeline& pipeline(Query query, Level level) const;

    Context& context_;
    std::span<const std::uint32_t> any_hit_, intersection_;
    // By query, and whether it refines.
    mutable std::array<std::array<std::unique_ptr<RayTracingPipeline>, 2>, 2> pipelines_;
};

}  // namespace twinray
