// SPDX-License-Identifier: MIT
// Builds, and refits, trees of one triangle or box each, which need neither an order nor a hierarchy.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/swtlas/lone_leaf.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main()
{
    uint index = global_index();
    if (index >= args.leaf_count) return;
    BuildTree tree = AT(args.trees, index);
    Leaf leaf = leaf_at(tree, 0u);
    BoxedLeaf boxed = boxed_leaf(tree, leaf);
    store_lone_tree(tree.bvh, tree.records, boxed.box);
    if (is_absent(tree.records)) AT(tree.triangles, 0) = boxed.last;
    else store_record(tree.records, 0u, encode_boxed_leaf(tree, leaf, boxed));
}
