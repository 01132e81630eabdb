// SPDX-License-Identifier: MIT
// A box around all usable instances, and how many are not.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/engine/group_box.glsl"
layout(local_size_x = WORLD_BOUND_GROUP) in;
layout(push_constant, scalar) uniform Push { WorldBoundArgs args; };

GeometryBox box_of(InstanceRecord record)
{
    if (record.geometry == 0ul) return no_box();
    Rows to_world = to_world_of(record);
    if (!is_usable(to_world, inverse_of(to_world)))
    {
        atomicAdd(AT(args.bits, 0).unusable_count, 1u);
        return no_box();
    }
    GeometryBox box = AT(REF(GeometryBox)(record.geometry), 0);
    if (!(box.lo.x <= box.hi.x)) return no_box();
    return box_in_world(box, to_world);
}

void main()
{
    if (group_index() >= args.group_count) return;
    uint index = global_index();
    GeometryBox box = no_box();
    if (index < args.count) box = box_of(in_built_units(AT(args.records, index)));
    if (!add_box(args.bits, args.group_count, box)) return;
    GeometryBox whole = whole_box(args.bits);
    WorldBound bound;
    bound.lo = whole.lo;
    bound.hi = whole.hi;
    bound.unusable_count = atomicAdd(AT(args.bits, 0).unusable_count, 0u);
    bound.reserved = 0u;
    AT(args.result, 0) = bound;
}
