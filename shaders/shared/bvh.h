// SPDX-License-Identifier: MIT
// The software accelerator's structures in device memory.
//
//   SwTlasHeader -> top-level Bvh over instances -> SwInstance -> bottom-level Bvh over triangles
//
// Trees are built binary, of BvhNodes. In layout bvh2 they stay; in the other layouts a tree of CompressedRecords takes
// their place.
//
// A reference to a child is the index of an inner node, or LEAF_BIT with the index of a leaf. n leaves have n - 1
// inner nodes; with one leaf the root is that leaf, with none it is NOTHING. Records have their root at 0.
#ifndef TWINRAY_SHARED_BVH_H
#define TWINRAY_SHARED_BVH_H
#include "twinray/glsl/instance.h"
#include "twinray/glsl/accel_header.h"

const uint LEAF_BIT = 0x80000000u;
const uint INSTANCE_BIT = 0x40000000u;  // in records of leaves
const uint PAIR_BIT = 0x20000000u;      // in records of leaves of two triangles
const uint WIDE_BIT = INSTANCE_BIT;     // in other records
const uint NOTHING = 0xffffffffu;

// Inner nodes on a path split on ever lower bits of (60-bit Morton code, 25-bit position).
const uint DEEPEST_TREE = 85u;
const uint DEEPEST_RECORDS = (DEEPEST_TREE + 1u) / 2u;  // inner nodes on a path of records, see collapse.h

struct LeafBox {
    vec3 lo;  // lo > hi: empty
    vec3 hi;
};
BUFFER_OF(LeafBox, 8);

// Comparisons give the same bits everywhere: min() and max() may give either of two zeros.
FUNC vec3 min_by_comparison(vec3 a, vec3 b) {
    return vec3(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z);
}
FUNC vec3 max_by_comparison(vec3 a, vec3 b) {
    return vec3(a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z);
}
FUNC LeafBox around_both(LeafBox a, LeafBox b) {
    LeafBox box;
    box.lo = min_by_comparison(a.lo, b.lo);
    box.hi = max_by_comparison(a.hi, b.hi);
    return box;
}

// 64 bytes. Child boxes are in the parent, so that one fetch decides both. A box is empty if lo > hi.
struct BvhNode {
    vec3 lo0;
    uint child0;
    vec3 hi0;
    uint subtree0;  // of child0, see subtree_info; in finished trees of layout bvh2 the node's own edge, see make_edge
    vec3 lo1;
    uint child1;
    vec3 hi1;
    uint subtree1;
};
BUFFER_OF(BvhNode, 16);

// Each half of a node, as others write it alone.
struct BvhChild {
    vec3 lo;
    uint child;
    vec3 hi;
    uint subtree;
};

FUNC BvhChild child_of(BvhNode node, uint side) {
    BvhChild child;
    child.lo = side == 0u ? node.lo0 : node.lo1;
    child.child = side == 0u ? node.child0 : node.child1;
    child.hi = side == 0u ? node.hi0 : node.hi1;
    child.subtree = side == 0u ? node.subtree0 : node.subtree1;
    return child;
}

// 40 bytes; all vertices are 0 for a triangle that is not active (see triangle.h), which is never hit. For a box, v0
// and v1 are its lowest and highest corner.
struct BvhTriangle {
    vec3 v0;
    vec3 v1;
    vec3 v2;
    uint primitive_index;
};
BUFFER_OF(BvhTriangle, 8);

// 40 bytes, see compressed.h.
//
// node       a: lower corner of the grid, the last 8 bits of each coordinate being the exponent of the cells'
//            size there;
//               w: the first child, count of children << 26, in layout compressed8 and WIDE_BIT
//            b: lo.x, hi.x, lo.y, hi.y in cells, 8 bits a child      c: lo.z, hi.z
// second half of a node of layout compressed8, of its last four slots
//            a.x: see ChildSlots, axes << 16 (see encode_node.h); w: WIDE_BIT      b, c: as in a node
// primitive  a: v0; w: LEAF_BIT | primitive_index      b: v1; w, c: v2
// two        a.w: LEAF_BIT | PAIR_BIT | index of the first triangle; x: index of the second, with FIRST_ACTIVE and
// triangles  SECOND_ACTIVE for those that can be hit; y, z: the vertices of the edge that they share
//            b.x, b.y: the third vertex of the first, of the second; z: see LeafVertices::corners
// instance   a.w: LEAF_BIT | INSTANCE_BIT | index
// none       a.w: 0
struct CompressedRecord {
    uvec4 a;
    uvec4 b;
    uvec2 c;
};
BUFFER_OF(CompressedRecord, 8);

struct Bvh {
    vec3 lo;  // around all active leaves; lo > hi: there are none
    vec3 hi;
    REF(BvhNode) nodes;  // of layout bvh2, else absent
    uint root;
    uint leaf_count;
};
BUFFER_OF(Bvh, 8);

// The target of InstanceRecord::geometry for the software accelerator. Begins with a GeometryBox.
struct SwGeometry {
    Bvh bvh;
    REF(BvhTriangle) triangles;     // of layout bvh2, else absent
    REF(CompressedRecord) records;  // of all other layouts, else absent
    Floats vertices;                // 3 each, of leaves of two triangles, else absent
    uint kind;                      // GEOMETRY_*
    uint reserved;
};
BUFFER_OF(SwGeometry, 8);

// An instance as traversal reads it.
struct SwInstance {
    Rows world_to_object;
    REF(BvhNode) nodes;
    REF(BvhTriangle) triangles;
    REF(CompressedRecord) records;
    Floats vertices;
    uint root;
    uint custom_index_mask;
    uint flags;    // of the instance: INSTANCE_*
    uint kind;     // of its geometry
    float extent;  // the largest coordinate of the geometry's box
    uint reserved;
};
BUFFER_OF(SwInstance, 8);

struct SwTlasHeader {
    AccelHeader accel;
    Bvh bvh;
    REF(CompressedRecord) records;  // as in SwGeometry
    REF(SwInstance) instances;
    Uint64 instance_count;
};
BUFFER_OF(SwTlasHeader, 8);

// Packs the number of leaves below a child, and the most nodes on a way down from it, itself included.
FUNC uint subtree_info(uint leaves, uint height) { return leaves | height << 25u; }
FUNC uint leaves_in(uint subtree) { return subtree & 0x1ffffffu; }
FUNC uint height_in(uint subtree) { return subtree >> 25u; }

// Makes an edge: it names a child of a node of layout bvh2 by the node above it and its side. A built tree stores the
// edges of its inner nodes, as a way up to the root, whose edge is 0.
FUNC uint make_edge(uint node, uint side) { return (node + 1u) << 1u | side; }
FUNC uint parent_of_edge(uint edge) { return (edge >> 1u) - 1u; }
FUNC uint edge_of(REF(BvhNode) nodes, uint node) { return AT(nodes, node).subtree0; }
FUNC void set_edge(REF(BvhNode) nodes, uint child, uint edge) {
    if ((child & LEAF_BIT) == 0u) AT(nodes, child).subtree0 = edge;
}
FUNC void link_children(REF(BvhNode) nodes, uint node) {
    set_edge(nodes, AT(nodes, node).child0, make_edge(node, 0u));
    set_edge(nodes, AT(nodes, node).child1, make_edge(node, 1u));
}
FUNC uint child_at(REF(BvhNode) nodes, uint edge) {
    uint node = parent_of_edge(edge);
    return (edge & 1u) == 0u ? AT(nodes, node).child0 : AT(nodes, node).child1;
}

FUNC BvhNode load_node(REF(BvhNode) nodes, uint index) { return AT(nodes, index); }

FUNC SwInstance load_instance(REF(SwInstance) instances, uint index) { return AT(instances, index); }

FUNC LeafBox load_box(REF(LeafBox) boxes, uint index) { return AT(boxes, index); }

FUNC void store_box(REF(LeafBox) boxes, uint index, LeafBox box) { AT(boxes, index) = box; }

FUNC BvhTriangle load_triangle(REF(BvhTriangle) triangles, uint index) { return AT(triangles, index); }
#endif
