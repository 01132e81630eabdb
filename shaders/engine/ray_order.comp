// SPDX-License-Identifier: MIT
// The box of the origins of the rays that are traced, and the keys by which rays are sorted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/ray_order.h"
layout(local_size_x = WORLD_BOUND_GROUP) in;
layout(push_constant, scalar) uniform Push { RayOrderArgs args; };

#ifdef KERNEL_RAY_BOX
#include "shaders/engine/group_box.glsl"

void main() {
    if (group_index() >= args.group_count) return;
    GeometryBox box = no_box();
    uint count = ray_count(args.count, args.indirect_count);
    uint stride = args.group_count * WORLD_BOUND_GROUP;
    for (uint i = global_index(), left = RAYS_IN_BOX; left > 0u && i < count; i += stride, left--) {
        Ray ray = AT(args.rays, i);
        if (!is_traceable(ray)) continue;
        box.lo = min(box.lo, ray.origin);
        box.hi = max(box.hi, ray.origin);
    }
    add_box(args.box, args.group_count, box);
}
#endif

#ifdef KERNEL_RAY_KEYS
void main() {
    uint i = global_index();
    if (i >= args.count) return;
    // The sort is stable: of rays with the last key, those within the count stay before those beyond.
    uint key = LAST_RAY_KEY;
    if (i < ray_count(args.count, args.indirect_count)) key = ray_key(AT(args.rays, i), box_of(AT(args.box, 0)));
    AT(args.keys, i) = key;
}
#endif
