// SPDX-License-Identifier: MIT
// Writes the nodes of one level: boxes around their children. Nodes without leaves below them are empty.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/box_tree.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { BoxTreeArgs args; };

TreeBox load(uint node)
{
    if (node >= args.leaf_begin + args.count) return empty_tree_box();
    return AT(args.nodes, node);
}

uint leaves_of(TreeBox box, uint node)
{
    if (node < args.leaf_begin) return box.item;
    return is_empty(box) ? 0u : 1u;
}

void main()
{
    uint i = global_index();
    if (i >= args.first) return;
    uint node = args.first + i;
    TreeBox left = load(2u * node);
    TreeBox right = load(2u * node + 1u);
    TreeBox both = around(left, right);
    both.item = leaves_of(left, 2u * node) + leaves_of(right, 2u * node + 1u);
    if (is_empty(right)) both.group = left.group;
    AT(args.nodes, node) = both;
}
