// SPDX-License-Identifier: MIT
// The world boxes of instances, rounded outward, for either accelerator; the leaves of a tree, boxes in sorted order,
// and the nodes of one level, boxes around their children.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/box_tree.h"
layout(local_size_x = 64) in;

#ifdef KERNEL_INSTANCE_BOXES
layout(push_constant, scalar) uniform Push { InstanceBoxesArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    bool is_unusable = false;
    GeometryBox box = instance_box(AT(args.records, i), is_unusable);
    TreeBox result = empty_tree_box();
    uint item = args.first_item + i;
    if (!(box.lo.x > box.hi.x)) result = tree_box(box, item, item);
    AT(args.boxes, i) = result;
}
#else
layout(push_constant, scalar) uniform Push { BoxTreeArgs args; };
#endif

#ifdef KERNEL_LEAVES
void main() {
    uint i = global_index();
    if (i < args.count) AT(args.nodes, args.leaf_begin + i) = AT(args.boxes, AT(args.order, i));
}
#endif

#ifdef KERNEL_LEVEL
// Nodes without leaves below them are empty.
TreeBox load(uint node) {
    if (node >= args.leaf_begin + args.count) return empty_tree_box();
    return AT(args.nodes, node);
}

uint leaves_of(TreeBox box, uint node) {
    if (node < args.leaf_begin) return box.item;
    return is_empty(box) ? 0u : 1u;
}

void main() {
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
#endif
