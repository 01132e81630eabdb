// SPDX-License-Identifier: MIT
// Finishes trees of layout bvh2 and refits them, one invocation per leaf or inner node.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
#if defined(KERNEL_LINK_NODES) || defined(KERNEL_ENCODE_TRIANGLES)
layout(push_constant, scalar) uniform Push { BuildArgs args; };
#else
layout(push_constant, scalar) uniform Push { RefitArgs args; };
#endif

#ifdef KERNEL_LINK_NODES
// Links an inner node to the one above it.
void do_leaf(BuildTree tree, uint leaf) {
    uint node = leaf - tree.first;
    if (node + 1u >= tree.count) return;
    if (node == AT(tree.bvh, 0).root) set_edge(tree.nodes, node, 0u);
    link_children(tree.nodes, node);
}
#endif

#ifdef KERNEL_ENCODE_TRIANGLES
// Writes a triangle in sorted order, with its vertices.
void do_leaf(BuildTree tree, uint leaf) {
    AT(tree.triangles, leaf - tree.first) = boxed_primitive(tree, AT(args.order, leaf) - tree.first).primitive;
}
#endif

#ifdef KERNEL_LEAF_EDGES
void set_leaf(uint first, uint child, uint edge) {
    if ((child & LEAF_BIT) != 0u) AT(args.parents, first + (child & ~LEAF_BIT)) = edge;
}

// Stores the edges that lead to the leaves of an inner node.
void do_leaf(BuildTree tree, uint leaf) {
    uint node = leaf - tree.first;
    if (node == 0u) set_leaf(tree.first, AT(tree.bvh, 0).root, 0u);
    if (node + 1u >= tree.count) return;
    BvhNode children = AT(tree.nodes, node);
    set_leaf(tree.first, children.child0, make_edge(node, 0u));
    set_leaf(tree.first, children.child1, make_edge(node, 1u));
}
#endif

#ifdef KERNEL_REFIT_TRIANGLES
// Refits a triangle whose vertices moved: vertices and box, in the order of its tree.
void do_leaf(BuildTree tree, uint leaf) {
    uint position = leaf - tree.first;
    BoxedPrimitive boxed = boxed_primitive(tree, AT(tree.triangles, position).primitive_index);
    store_box(args.boxes, leaf, boxed.box);
    AT(tree.triangles, position) = boxed.primitive;
}
#endif

#ifdef KERNEL_REFIT
// All groups see the same nodes, not through caches of one.
REFERENCE(SharedNodes, coherent, BvhNode items[], 16)

// Makes new boxes for an old topology: the leaf goes up with its box, and of the two children that arrive at a node the
// second continues with both.
void do_leaf(BuildTree tree, uint leaf) {
    SharedNodes nodes = SharedNodes(tree.nodes.address);
    LeafBox box = AT(args.boxes, leaf);
    uint edge = AT(args.parents, leaf);
    while (edge != 0u) {
        uint node = parent_of_edge(edge);
        bool is_second = (edge & 1u) != 0u;
        if (is_second) {
            AT(nodes, node).lo1 = box.lo;
            AT(nodes, node).hi1 = box.hi;
        } else {
            AT(nodes, node).lo0 = box.lo;
            AT(nodes, node).hi0 = box.hi;
        }
        memoryBarrierBuffer();
        if (atomicAdd(AT(args.missing, tree.first + node), 1u) == NOTHING) return;
        memoryBarrierBuffer();
        box.lo = min(box.lo, is_second ? AT(nodes, node).lo0 : AT(nodes, node).lo1);
        box.hi = max(box.hi, is_second ? AT(nodes, node).hi0 : AT(nodes, node).hi1);
        edge = edge_of(tree.nodes, node);
    }
    AT(tree.bvh, 0).lo = box.lo;
    AT(tree.bvh, 0).hi = box.hi;
}
#endif

void main() {
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    if (gl_LocalInvocationIndex >= chunk.count) return;
    do_leaf(AT(args.trees, chunk.tree), chunk.first + gl_LocalInvocationIndex);
}
