// SPDX-License-Identifier: MIT
// Computes the world boxes of instances, rounded outward, for either accelerator.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/box_tree.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { InstanceBoxesArgs args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    bool is_unusable = false;
    GeometryBox box = instance_box(AT(args.records, i), is_unusable);
    TreeBox result = empty_tree_box();
    uint item = args.first_item + i;
    if (!(box.lo.x > box.hi.x)) result = tree_box(box, item, item);
    AT(args.boxes, i) = result;
}
