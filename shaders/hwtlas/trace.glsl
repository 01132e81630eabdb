// SPDX-License-Identifier: MIT
// What the ray query kernel and the ray tracing pipeline share. Needs hw_scene.h before it.
#ifndef TWINRAY_HWTLAS_TRACE_GLSL
#define TWINRAY_HWTLAS_TRACE_GLSL

FEATURE(HW_HAS_REMAP, HAS_REMAP)
FEATURE(HW_IS_ANY, IS_ANY)

layout(push_constant, scalar) uniform Push { HwTraceArgs args; };

// ids: what the driver calls InstanceId and PrimitiveId.
Hit hit_of(uvec2 ids, uint custom_index, float t, vec2 barycentrics)
{
    Hit hit;
    hit.hit = 1u;
    hit.t = t;
    hit.primitive_index = ids.y;
    hit.custom_index = custom_index;
    hit.u = barycentrics.x;
    hit.v = barycentrics.y;
    hit.instance_index = ids.x;
    hit.flags = 0u;
    if (HAS_REMAP)
    {
        HwInstance instance = AT(AT(args.scene, 0).instances, ids.x);
        hit.instance_index = instance.instance_index;
        hit.primitive_index = AT(instance.triangles, ids.y);
    }
    return hit;
}
#endif
