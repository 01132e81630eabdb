// SPDX-License-Identifier: MIT
// Builds, and refits, a top level of one instance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/place_instance.h"
#include "shaders/swtlas/lone_leaf.glsl"
layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { LoneInstanceArgs args; };

void main()
{
    if (global_index() != 0u) return;
    LeafBox box = empty_box();
    InstanceRecord record = in_built_units(AT(args.records, 0));
    AT(args.instances, 0) = place_instance(record, absent_near(args.records.address), false, box);
    store_lone_tree(args.bvh, args.leaves, box);
    if (!is_absent(args.leaves)) store_record(args.leaves, 0u, encode_instance(0u));
}
