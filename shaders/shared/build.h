// SPDX-License-Identifier: MIT
// What the build kernels of the software accelerator share. A batch builds many trees at once: its leaves stand one
// tree after the other, and a block is a run of up to BUILD_GROUP leaves of one tree.
#ifndef TWINRAY_SHARED_BUILD_H
#define TWINRAY_SHARED_BUILD_H
#include "shaders/shared/bvh.h"
#include "shaders/shared/ray.h"
#include "shaders/shared/transform.h"
#include "shaders/shared/triangle.h"
#include "shaders/shared/workgroup.h"

const uint BUILD_GROUP = 256u;
const uint LEAVES_GROUP = 32u; // invocations that share a block's leaves where they need each other, on a GPU
const uint INACTIVE_CODE = 0x3fffffffu; // Morton code of leaves without a finite box: last

// Box of a tree's leaf centres, as ordered bits (see ordered_bits).
struct CentroidBounds
{
    uvec3 lo;
    uvec3 hi;
};
BUFFER_OF(CentroidBounds, 4);

// One tree of the batch, with leaves first .. first + count - 1.
struct BuildTree
{
    uint first;
    uint count;
    Floats positions;              // 3 floats a vertex of triangles, 6 a box; null: instances
    Uints indices;                 // 3 a triangle; null: boxes
    REF(Bvh) bvh;
    REF(BvhNode) nodes;            // of the scratch where there are records
    REF(BvhTriangle) triangles;    // of layout bvh2
    REF(CompressedRecord) records; // of all other layouts
};
BUFFER_OF(BuildTree, 8);

struct BuildBlock
{
    uint tree;
    uint first;
    uint count;
};
BUFFER_OF(BuildBlock, 4);

struct TriangleLeavesArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    REF(LeafBox) boxes;
    REF(CentroidBounds) centroids; // one per tree
    uint block_count;
    uint reserved;
};

struct InstanceLeavesArgs
{
    REF(InstanceRecord) records;
    REF(SwInstance) instances;
    REF(BuildBlock) blocks;
    REF(LeafBox) boxes;
    REF(CentroidBounds) centroids;
    uint block_count;
    uint reserved;
};

struct MortonArgs
{
    REF(BuildBlock) blocks;
    REF(LeafBox) boxes;
    REF(CentroidBounds) centroids;
    Uints codes;   // by leaf
    Uints tree_of; // by leaf; 0 = not wanted (a single tree)
    uint block_count;
    uint reserved;
};

// Where Morton codes collide, as in a mesh with parts that are far smaller than the whole, the leaves of that tree are
// sorted again, by fine codes too: else their order would mean nothing there.
const uint CROWD = 16u; // leaves that follow one of the same code, in order: a crowd

// Written on the device, which dispatches the second sort, or nothing.
struct Crowding
{
    uint is_fine; // 1: some trees need fine codes; the others have 0 for them
    uint leaf_groups[3]; // of a dispatch over all leaves
    uint sort_groups[3]; // of a pass of the sort
    uint scan_groups[3];
};
BUFFER_OF(Crowding, 4);

// `crowded`: leaves of a tree that begin a crowd.
FUNC bool needs_fine_codes(uint crowded, uint leaf_count) { return crowded > leaf_count / 8u; }

struct CrowdingArgs
{
    Uints codes;   // in order
    Uints order;
    Uints tree_of; // by leaf; 0: a single tree
    REF(BuildTree) trees;
    Uints crowded; // by tree: how many leaves begin a crowd, counted until that is enough
    REF(Crowding) crowding;
    uint count;
    uint leaf_groups;
    uint sort_groups;
    uint reserved;
};

struct FineCodesArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    REF(LeafBox) boxes;
    REF(CentroidBounds) centroids;
    Uints crowded;    // by tree
    Uints fine_codes; // by leaf
    uint block_count;
    uint reserved;
};

// keys[i] = values[order[i]]
struct GatherKeysArgs
{
    Uints values;
    Uints order;
    Uints keys;
    uint count;
    uint reserved;
};

// Specialisations of the hierarchy kernel.
const uint HIERARCHY_FAST = 0u;
const uint HIERARCHY_HIGH = 1u; // with rotations

// Of both kernels that make hierarchies.
struct HierarchyArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    REF(LeafBox) boxes;
    Uints codes;            // in order
    Uints fine_codes;       // by leaf
    REF(Crowding) crowding;
    Uints order;
    Uints meeting;          // by inner node: the far end of the range that arrived first, NOTHING before
    REF(CentroidBounds) centroids;
    Uints tops;             // of quality ploc: of clusters, by the place of the first leaf of their range
    Uints last_leaves;      // and so their last leaves
    uint block_count;
    uint leaves_are_sorted; // 1: leaf references count sorted leaves; 0: they are the leaf's own index
    uint run;               // leaves of an invocation but of quality ploc, a divisor of BUILD_GROUP
    uint reserved;
};

// Of quality ploc, see ploc.h.
const uint PLOC_GROUP = 32u; // invocations at most, as many as clusters that they merge

// Links the nodes of built trees of layout bvh2 to those above them.
struct LinkNodesArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    uint block_count;
    uint reserved;
};

struct LeafEdgesArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    Uints leaf_edges; // by leaf, of all trees of the batch
    uint block_count;
    uint reserved;
};

// New boxes for an old topology.
struct RefitArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    REF(LeafBox) boxes;
    Uints leaf_edges;
    Uints arrived; // by inner node: NOTHING before its first child is done
    uint block_count;
    uint reserved;
};

struct RefitTrianglesArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    REF(LeafBox) boxes; // by place in the tree's order
    uint block_count;
    uint reserved;
};

// New records for an old topology. A tree's slots are its places for records; they begin at 2 * BuildTree::first.
struct RecordParentsArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    Uints parents; // by slot: that of the node above, NOTHING for the root
    Uints missing; // by slot of a node: how many of its children have no box yet
    uint block_count;
    uint reserved;
};

struct RefitRecordsArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    REF(LeafBox) boxes; // of instances
    REF(LeafBox) slot_boxes;
    Uints parents;
    Uints missing;
    uint block_count;
    uint reserved;
};

struct EncodeRecordsArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    Uints order;
    Uints places; // by place in the order: the leaf's slot
    uint block_count;
    uint reserved;
};

struct EncodeTrianglesArgs
{
    REF(BuildTree) trees;
    REF(BuildBlock) blocks;
    Uints order;
    uint block_count;
    uint reserved;
};

FUNC bool is_active(LeafBox box) { return box.lo.x <= box.hi.x; }

FUNC LeafBox empty_box()
{
    LeafBox box;
    box.lo = vec3(uintBitsToFloat(0x7f800000u));
    box.hi = vec3(uintBitsToFloat(0xff800000u));
    return box;
}

// The middle without overflow, which (lo + hi) / 2 has above 1.7e38.
FUNC vec3 center_of(LeafBox box)
{
    PRECISE vec3 half_lo = box.lo * 0.5f;
    PRECISE vec3 half_hi = box.hi * 0.5f;
    PRECISE vec3 center = half_lo + half_hi;
    return center;
}

FUNC bool has_instances(BuildTree tree) { return is_null(tree.positions); }
FUNC bool has_boxes(BuildTree tree) { return is_null(tree.indices); }

FUNC BvhTriangle fetch_primitive(BuildTree tree, uint primitive)
{
    BvhTriangle triangle;
    if (has_boxes(tree))
    {
        triangle.v0 = load_position(tree.positions, primitive * 2u);
        triangle.v1 = load_position(tree.positions, primitive * 2u + 1u);
        triangle.v2 = vec3(0.0f);
        triangle.primitive_index = primitive;
        return triangle;
    }
    uvec3 corners = load_indices(tree.indices, primitive);
    triangle.v0 = load_position(tree.positions, corners.x);
    triangle.v1 = load_position(tree.positions, corners.y);
    triangle.v2 = load_position(tree.positions, corners.z);
    triangle.primitive_index = primitive;
    return triangle;
}

// Triangles that cannot be hit keep their place in the tree with an empty box.
FUNC LeafBox box_of_triangle(BvhTriangle t)
{
    if (!is_active_triangle(t.v0, t.v1, t.v2)) return empty_box();
    LeafBox box;
    box.lo = lesser_of(t.v0, lesser_of(t.v1, t.v2));
    box.hi = greater_of(t.v0, greater_of(t.v1, t.v2));
    return box;
}

FUNC LeafBox box_of_primitive(BuildTree tree, uint primitive)
{
    BvhTriangle fetched = fetch_primitive(tree, primitive);
    if (!has_boxes(tree)) return box_of_triangle(fetched);
    LeafBox box;
    box.lo = fetched.v0;
    box.hi = fetched.v1;
    return box;
}

// A triangle as traversal wants it.
FUNC BvhTriangle without_inactive_corners(BvhTriangle t)
{
    if (is_active_triangle(t.v0, t.v1, t.v2)) return t;
    t.v0 = vec3(0.0f);
    t.v1 = vec3(0.0f);
    t.v2 = vec3(0.0f);
    return t;
}
#endif
