// SPDX-License-Identifier: MIT
// The same shots through a ray tracing pipeline: candidates come up in any-hit and intersection shaders.
#pragma once

#include "hwtlas/ray_tracing_pipeline.h"
#include "report/conformance/query.h"

namespace twinray::conformance {

class PipelineQuery {
  public:
    // Instances of triangles are to take the first hit record, those of boxes the second.
    explicit PipelineQuery(Context& context) : pipeline_(context, desc(context)) {}

    // Opens passes. The answers become zeros first.
    void record(Commands& commands, const QueryArgs& args, const Buffer& answers) const;

  private:
    static RayTracingPipelineDesc desc(const Context& context);

    RayTracingPipeline pipeline_;
};

}  // namespace twinray::conformance
