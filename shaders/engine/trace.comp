// SPDX-License-Identifier: MIT
// Traces a batch of rays, one per invocation: a kernel like those of users.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/query.glsl"
#ifdef TWINRAY_PROGRAM
#include "twinray_program.glsl"
#endif
layout(local_size_x = 64) in;
layout(constant_id = QUERY_CONSTANT) const uint TRACE_QUERY = QUERY_CLOSEST;
layout(constant_id = HANDS_CONSTANT) const uint TRACE_HANDS = 0u;
layout(push_constant, scalar) uniform Push { TraceArgs args; };

void main()
{
    uint place = dealt_index(TRACE_HANDS);
    if (place >= ray_count(args.count, args.indirect_count)) return;
    uint i = ray_at(args.order, place);
    TraceOptions options = trace_options(args.mask, args.flags, TRACE_QUERY);
    options.user_data = args.user_data;
    Hit hit = trace(args.scene, AT(args.rays, i), options);
    if ((TRACE_FEATURES & FEATURE_HITS) != 0u) AT(args.hits, i) = hit;
    else AT(args.hits, i).hit = hit.hit;
}
