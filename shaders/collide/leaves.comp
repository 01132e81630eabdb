// SPDX-License-Identifier: MIT
// Writes the leaves: boxes in sorted order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/box_tree.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { BoxTreeArgs args; };

void main()
{
    uint i = global_index();
    if (i < args.count) AT(args.nodes, args.leaf_begin + i) = AT(args.boxes, AT(args.order, i));
}
