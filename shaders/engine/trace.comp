// SPDX-License-Identifier: MIT
// Traces a batch of rays: a kernel like those of users. An invocation has one ray, or on a CPU a run of them
// (groups_for_rays in engine/accel/trace_program.h): neighbours find the data of those before them in the caches.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef TWINRAY_WIDE_LOADS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif
#include "twinray/glsl/query.glsl"
#ifdef TWINRAY_PROGRAM
#include "twinray_program.glsl"
#endif
layout(local_size_x = 64, local_size_x_id = RAY_GROUP_CONSTANT) in;
layout(constant_id = QUERY_CONSTANT) const uint TRACE_QUERY = QUERY_CLOSEST;
layout(constant_id = INTERLEAVE_CONSTANT) const uint TRACE_INTERLEAVE = 0u;
layout(push_constant, scalar) uniform Push { TraceArgs args; };

void trace_ray(uint position, TraceOptions options) {
    uint i = ray_at(args.order, position);
    Hit hit = trace(args.scene, load_ray(args.rays, i), options);
    if ((TRACE_FEATURES & FEATURE_HITS) != 0u)
        store_hit(args.hits, i, hit);
    else
        AT(args.hits, i).hit = hit.hit;
}

void main() {
    uint count = ray_count(args.count, args.indirect_count);
    uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    uint size = gl_WorkGroupSize.x;
    uint run = TRACE_INTERLEAVE == 0u ? 1u : run_of_blocks(count, size, groups);
    uint first = interleaved_group(group_index(), groups, TRACE_INTERLEAVE) * run * size + gl_LocalInvocationID.x;
    TraceOptions options = trace_options(args.mask, args.flags, TRACE_QUERY, args.user_data);
    if (TRACE_INTERLEAVE == 0u) {
        if (first < count) trace_ray(first, options);
        return;
    }
    for (uint k = 0u; k < run && first + k * size < count; ++k) trace_ray(first + k * size, options);
}
