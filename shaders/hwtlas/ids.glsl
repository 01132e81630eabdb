// SPDX-License-Identifier: MIT
// Maps the driver's numbering back to the user's.
#ifndef TWINRAY_HWTLAS_IDS_GLSL
#define TWINRAY_HWTLAS_IDS_GLSL
#include "shaders/shared/world_bound.h"
#include "shaders/shared/hw_tlas_header.h"
#include "shaders/shared/trace.h"

// instance_id, primitive_id: the driver's InstanceId and PrimitiveId.
Candidate candidate_of(HwTlasHeader scene, uint instance_id, uint primitive_id, uint custom_index, bool is_front,
                       TraceOptions options) {
    Candidate candidate;
    candidate.primitive_index = primitive_id;
    candidate.instance_index = instance_id;
    candidate.custom_index = custom_index;
    candidate.is_front = is_front;
    candidate.user_data = options.user_data;
    if ((options.features & FEATURE_REMAP) != 0u && !is_absent(scene.instances)) {
        HwInstance instance = AT(scene.instances, instance_id);
        candidate.instance_index = instance.instance_index;
        candidate.primitive_index = AT(instance.triangles, primitive_id);
    }
    return candidate;
}

Hit hit_of(Candidate candidate, float t, vec2 uv) {
    Hit hit;
    hit.hit = 1u;
    hit.t = t;
    hit.primitive_index = candidate.primitive_index;
    hit.custom_index = candidate.custom_index;
    hit.u = uv.x;
    hit.v = uv.y;
    hit.instance_index = candidate.instance_index;
    hit.flags = candidate.is_front ? HIT_FRONT : 0u;
    return hit;
}

// Returns the ray flags for the driver.
uint ray_flags(TraceOptions options, uint opaque, uint terminate_on_first_hit) {
    uint flags = options.flags;
    if ((options.features & FEATURE_FILTERS) == 0u) flags |= opaque;
    if (options.query == QUERY_ANY) flags |= terminate_on_first_hit;
    return flags;
}
#endif
