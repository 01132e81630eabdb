// SPDX-License-Identifier: MIT
// The common part of the build kernels of the software accelerator. A batch builds many trees at once: its leaves are
// in order of the trees, in chunks of up to BUILD_GROUP leaves of one tree.
#ifndef TWINRAY_SHARED_BUILD_H
#define TWINRAY_SHARED_BUILD_H
#include "shaders/shared/bvh.h"
#include "shaders/shared/leaf.h"
#include "twinray/glsl/triangle.h"
#include "shaders/shared/workgroup.h"

const uint BUILD_GROUP = 256u;
const uint LEAVES_GROUP = 32u;           // invocations that share a chunk's leaves where they need each other, on a GPU
const uint INACTIVE_CODE = 0x3fffffffu;  // Morton code of leaves without a finite box: last

// Box of a tree's leaf centres, as ordered bits (see ordered_bits).
struct CentroidBounds {
    uvec3 lo;
    uvec3 hi;
};
BUFFER_OF(CentroidBounds, 4);

// One tree of the batch, with leaves first .. first + count - 1.
struct BuildTree {
    uint first;
    uint count;
    Floats positions;  // 3 floats a vertex of triangles, 6 a box; absent: instances
    Uints indices;     // 3 a triangle; absent: boxes
    REF(Leaf) leaves;  // absent: leaf i is primitive i
    REF(Bvh) bvh;
    REF(BvhNode) nodes;             // of the scratch where there are records
    REF(BvhTriangle) triangles;     // of layout bvh2
    REF(CompressedRecord) records;  // of all other layouts
};
BUFFER_OF(BuildTree, 8);

// A chunk of leaves of one tree, which one group does.
struct LeafChunk {
    uint tree;
    uint first;
    uint count;
};
BUFFER_OF(LeafChunk, 4);

// If Morton codes collide, as in a mesh with parts that are far smaller than the whole, the leaves of that tree are
// sorted again, also by the lower half of 60-bit codes: else their order would mean nothing there.
const uint MANY_DUPLICATES = 16u;  // leaves that follow one of the same code, in order

// Written on the device, which then dispatches the second sort, or nothing.
struct DuplicateCodes {
    uint has_low_codes;   // 1: some trees are sorted by low codes; the others have 0 for them
    uint leaf_groups[3];  // of a dispatch over all leaves
    uint sort_groups[3];  // of a pass of the sort
    uint scan_groups[3];
};
BUFFER_OF(DuplicateCodes, 4);

// `duplicates`: leaves of a tree that are followed by MANY_DUPLICATES equal ones.
FUNC bool needs_low_codes(uint duplicates, uint leaf_count) { return duplicates > leaf_count / 8u; }

// The contents of a batch: the argument of all stages of a build that take nothing else.
struct BuildArgs {
    REF(BuildTree) trees;
    REF(LeafChunk) chunks;
    REF(LeafBox) boxes;
    REF(CentroidBounds) centroids;  // one per tree
    Uints codes;                    // Morton codes by leaf; from the sort on in order
    Uints low_codes;                // by leaf: the lower halves of 60-bit Morton codes
    Uints tree_of;                  // by leaf; absent: a single tree
    Uints duplicates;               // by tree, counted until they are enough: see needs_low_codes
    REF(DuplicateCodes) duplicate_codes;
    Uints order;         // the leaves in order
    Uints other_bounds;  // by inner node: the far end of the range that arrived first, NOTHING before
    Uints tops;          // of quality ploc: of clusters, by the first leaf of their range in order
    Uints last_leaves;   // and so their last leaves
    uint chunk_count;
    uint leaf_count;
    uint leaves_are_sorted;      // 1: leaf references count sorted leaves; 0: they are the leaf's own index
    uint leaves_per_invocation;  // of the hierarchy but of quality ploc, a divisor of BUILD_GROUP
};

// The leaves of a top level.
struct InstanceLeavesArgs {
    REF(InstanceRecord) records;
    REF(SwInstance) instances;
    REF(LeafChunk) chunks;
    REF(LeafBox) boxes;
    REF(CentroidBounds) centroids;
    uint chunk_count;
    uint reserved;
};

// A top level of one instance.
struct LoneInstanceArgs {
    REF(InstanceRecord) records;
    REF(SwInstance) instances;
    REF(Bvh) bvh;
    REF(CompressedRecord) leaves;  // absent in layout bvh2
};

struct DuplicateCodesArgs {
    BuildArgs build;
    uint leaf_groups;
    uint sort_groups;
};

// keys[i] = values[order[i]]
struct GatherKeysArgs {
    Uints values;
    Uints order;
    Uints keys;
    uint count;
    uint reserved;
};

// Specialisations of the hierarchy kernel.
const uint HIERARCHY_FAST = 0u;
const uint HIERARCHY_HIGH = 1u;  // with rotations

// For quality ploc, see ploc.h.
const uint PLOC_GROUP = 32u;  // invocations at most, as many as clusters that they merge

// New boxes for an old topology. A tree's slots are its indices of records; they begin at 2 * BuildTree::first.
struct RefitArgs {
    REF(BuildTree) trees;
    REF(LeafChunk) chunks;
    REF(LeafBox) boxes;       // of leaves
    REF(LeafBox) slot_boxes;  // of layouts of records
    Uints parents;  // by slot: that of the node above, NOTHING for the root; in layout bvh2 by leaf: the edge to it
    Uints missing;  // by slot of a node: how many of its children have no box yet; in layout bvh2 by inner node, from
                    // NOTHING on: how many have one
    uint chunk_count;
    uint reserved;
};

FUNC bool is_active(LeafBox box) { return box.lo.x <= box.hi.x; }

FUNC LeafBox empty_box() {
    LeafBox box;
    box.lo = vec3(uintBitsToFloat(0x7f800000u));
    box.hi = vec3(uintBitsToFloat(0xff800000u));
    return box;
}

// Returns the middle without overflow, which (lo + hi) / 2 has above 1.7e38.
FUNC vec3 center_of(LeafBox box) {
    PRECISE vec3 half_lo = box.lo * 0.5f;
    PRECISE vec3 half_hi = box.hi * 0.5f;
    PRECISE vec3 center = half_lo + half_hi;
    return center;
}

FUNC bool has_instances(BuildTree tree) { return is_absent(tree.positions); }
FUNC bool has_boxes(BuildTree tree) { return is_absent(tree.indices); }

FUNC Leaf leaf_at(BuildTree tree, uint index) {
    if (is_absent(tree.leaves)) return make_leaf(index, index);
    return AT(tree.leaves, index);
}

FUNC BvhTriangle fetch_primitive(BuildTree tree, uint primitive) {
    BvhTriangle triangle;
    if (has_boxes(tree)) {
        triangle.v0 = load_position(tree.positions, primitive * 2u);
        triangle.v1 = load_position(tree.positions, primitive * 2u + 1u);
        triangle.v2 = vec3(0.0f);
        triangle.primitive_index = primitive;
        return triangle;
    }
    uvec3 vertices = load_indices(tree.indices, primitive);
    triangle.v0 = load_position(tree.positions, vertices.x);
    triangle.v1 = load_position(tree.positions, vertices.y);
    triangle.v2 = load_position(tree.positions, vertices.z);
    triangle.primitive_index = primitive;
    return triangle;
}

// Denormals, which devices may flush, are found by their bits and replaced by the nearest numbers below and above.
FUNC bool is_denormal(float x) { return (floatBitsToUint(x) << 1u) - 1u < 0xffffffu; }
FUNC float normal_next_to(float x, bool is_below) {
    const float LEAST_NORMAL = 1.17549435082e-38f;
    bool is_negative = floatBitsToUint(x) >> 31u != 0u;
    if (!is_denormal(x)) return x;
    if (is_negative != is_below) return 0.0f;
    return is_below ? -LEAST_NORMAL : LEAST_NORMAL;
}
FUNC vec3 normals_below(vec3 v) {
    return vec3(normal_next_to(v.x, true), normal_next_to(v.y, true), normal_next_to(v.z, true));
}
FUNC vec3 normals_above(vec3 v) {
    return vec3(normal_next_to(v.x, false), normal_next_to(v.y, false), normal_next_to(v.z, false));
}

FUNC LeafBox box_around_vertices(BvhTriangle t) {
    LeafBox box;
    box.lo = min_by_comparison(normals_below(t.v0), min_by_comparison(normals_below(t.v1), normals_below(t.v2)));
    box.hi = max_by_comparison(normals_above(t.v0), max_by_comparison(normals_above(t.v1), normals_above(t.v2)));
    return box;
}

// A primitive in the form for traversal, and the box around it.
struct BoxedPrimitive {
    BvhTriangle primitive;
    LeafBox box;
};

// Triangles that cannot be hit stay in the tree with an empty box.
FUNC BoxedPrimitive boxed_triangle(BvhTriangle t) {
    BoxedPrimitive boxed;
    boxed.primitive = t;
    boxed.box = empty_box();
    if (is_active_triangle(t.v0, t.v1, t.v2)) {
        boxed.box = box_around_vertices(t);
        return boxed;
    }
    boxed.primitive.v0 = vec3(0.0f);
    boxed.primitive.v1 = vec3(0.0f);
    boxed.primitive.v2 = vec3(0.0f);
    return boxed;
}
FUNC LeafBox box_of_triangle(BvhTriangle t) { return boxed_triangle(t).box; }
FUNC BvhTriangle without_inactive_vertices(BvhTriangle t) { return boxed_triangle(t).primitive; }

FUNC BoxedPrimitive boxed_primitive(BuildTree tree, uint index) {
    BvhTriangle fetched = fetch_primitive(tree, index);
    if (!has_boxes(tree)) return boxed_triangle(fetched);
    BoxedPrimitive boxed;
    boxed.primitive = fetched;
    boxed.box.lo = normals_below(fetched.v0);
    boxed.box.hi = normals_above(fetched.v1);
    return boxed;
}

// A leaf in the form for traversal.
struct BoxedLeaf {
    BvhTriangle last;   // of its primitives
    LeafBox box;        // around all of them
    uint which_active;  // bit i: that of number i can be hit
};

FUNC BoxedLeaf boxed_leaf(BuildTree tree, Leaf leaf) {
    BoxedLeaf boxed;
    boxed.box = empty_box();
    boxed.which_active = 0u;
    DONT_UNROLL for (uint i = 0u; i < (has_two(leaf) ? 2u : 1u); i = i + 1u) {
        BoxedPrimitive one = boxed_primitive(tree, i == 0u ? leaf.first : leaf.second);
        boxed.last = one.primitive;
        boxed.box = around_both(boxed.box, one.box);
        boxed.which_active = boxed.which_active | (is_active(one.box) ? 1u << i : 0u);
    }
    return boxed;
}
#endif
