// SPDX-License-Identifier: MIT
#include "report/conformance/pipeline_query.h"

#include "conformance_pipeline_rahit.spv.h"
#include "conformance_pipeline_rchit.spv.h"
#include "conformance_pipeline_rgen.spv.h"
#include "conformance_pipeline_rgen_culling.spv.h"
#include "conformance_pipeline_rint.spv.h"
#include "conformance_pipeline_rmiss.spv.h"
#include "engine/core/buffer.h"

namespace twinray::conformance {

RayTracingPipelineDesc PipelineQuery::desc(const Context& context) {
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

void PipelineQuery::record(Commands& commands, const QueryArgs& args, const Buffer& answers) const {
    Buffer arguments(commands.context(), {.name = "conformance arguments", .bytes = sizeof(QueryArgs)});
    {
        const auto pass = commands.pass("conformance arguments");
        commands.write(arguments, args);
        commands.fill(answers, 0, answers.bytes(), 0);
    }
    TraceArgs launch{};
    launch.user_data = arguments.address();
    launch.count = args.count;
    pipeline_.trace(commands, launch);
    commands.retain(std::move(arguments));
}

}  // namespace twinray::conformance
