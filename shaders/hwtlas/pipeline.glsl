// SPDX-License-Identifier: MIT
// The common beginning of all shaders of the ray tracing pipeline, after their extensions.
#ifndef TWINRAY_HWTLAS_PIPELINE_GLSL
#define TWINRAY_HWTLAS_PIPELINE_GLSL
#include "twinray/glsl/common.glsl"
#include "shaders/hwtlas/ids.glsl"

layout(constant_id = QUERY_CONSTANT) const uint TRACE_QUERY = QUERY_CLOSEST;
layout(constant_id = FEATURES_CONSTANT) const uint TRACE_FEATURES = FEATURES_ALL;
layout(push_constant, scalar) uniform Push { TraceArgs args; };

TraceOptions trace_options()
{
    TraceOptions options;
    options.mask = args.mask;
    options.flags = args.flags;
    options.query = TRACE_QUERY;
    options.level = LEVEL_WATERTIGHT; // the driver's test, whatever was asked for
    options.features = TRACE_FEATURES;
    options.user_data = args.user_data;
    return options;
}

HwTlasHeader scene() { return AT(REF(HwTlasHeader)(args.scene), 0); }

#ifdef TWINRAY_PROGRAM
#include "twinray_program.glsl"
#endif
#endif
