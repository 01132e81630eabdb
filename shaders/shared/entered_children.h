// SPDX-License-Identifier: MIT
// The children of a node that a ray enters, of any layout: the first one, and the others as an entry of the stack.
#ifndef TWINRAY_SHARED_ENTERED_CHILDREN_H
#define TWINRAY_SHARED_ENTERED_CHILDREN_H
#include "shaders/shared/enter_compressed.h"
#include "shaders/shared/enter_wide.h"

const uint ROOT_EDGE = 0u; // in every layout; beside the root there is nothing that a stack could lose

// A tree of one level; of its arrays a layout has some.
struct SwTree
{
    REF(BvhNode) nodes;
    REF(BvhTriangle) triangles;
    REF(CompressedRecord) records;
    Floats vertices;
    uint root;
};

// A node or leaf of a tree: the number of a record, for both, in layout compressed8 with LEAF_BIT where it is known to
// be a leaf, and with SECOND_BIT the second triangle of a leaf; in layout bvh2 a child and its edge.
const uint SECOND_BIT = INSTANCE_BIT;
struct TreePosition
{
    uint item;
    uint edge;
};

FUNC TreePosition at_record(uint index)
{
    TreePosition at;
    at.item = index;
    at.edge = index;
    return at;
}
FUNC TreePosition at_root(SwTree tree, bool is_binary)
{
    TreePosition at;
    at.item = is_binary ? tree.root : 0u;
    at.edge = ROOT_EDGE;
    return at;
}

FUNC SwTree top_tree(SwTlasHeader scene)
{
    SwTree tree;
    tree.nodes = scene.bvh.nodes;
    tree.triangles = REF(BvhTriangle)(scene.instances.address); // read of no leaf: they are instances
    tree.records = scene.records;
    tree.vertices = Floats(scene.instances.address);
    tree.root = scene.bvh.root;
    return tree;
}
FUNC SwTree tree_of(SwInstance instance)
{
    SwTree tree;
    tree.nodes = instance.nodes;
    tree.triangles = instance.triangles;
    tree.records = instance.records;
    tree.vertices = instance.vertices;
    tree.root = instance.root;
    return tree;
}

FUNC bool is_binary(SwTlasHeader scene, TraceOptions options)
{
    bool may_be = (options.features & FEATURE_BVH2) != 0u;
    bool may_have_records = (options.features & (FEATURE_COMPRESSED | FEATURE_COMPRESSED8)) != 0u;
    return may_be && (!may_have_records || is_absent(scene.records));
}
FUNC bool may_be_wide(TraceOptions options) { return (options.features & FEATURE_COMPRESSED8) != 0u; }
FUNC bool is_surely_wide(TraceOptions options)
{
    return (options.features & (FEATURE_COMPRESSED | FEATURE_COMPRESSED8 | FEATURE_BVH2)) == FEATURE_COMPRESSED8;
}

// The children of a node that the ray enters, the first one first, and the rest as an entry of the stack.
struct EnteredChildren
{
    TreePosition first;
    bool is_entered;
    uint others;   // or EMPTY_NODE_GROUP
    uint siblings; // in layout compressed8 the entry's other word, else 0
};

// `target`: not NOTHING, but what the ray is on its way back to.
FUNC EnteredChildren children_of_record(CompressedRecord record, SwTree tree, BoxRay ray, Search search, uint target,
                                         TraceOptions options)
{
    ChildKeys keys = enter_compressed(record, ray, search.t_min, search.t_best, options.query);
    if (target != NOTHING)
    {
        ChildSlots slots;
        slots.first = first_child_of(record);
        slots.mask = (1u << children_in(record)) - 1u;
        keys = keys_from(keys, slot_towards(tree.records, slots, target));
    }
    sort_keys(keys);
    EnteredChildren children;
    children.first = at_record(first_child_of(record) + (keys.key0 & 3u));
    children.is_entered = keys.key0 < NO_ENTRY;
    children.others = node_group_of(keys, first_child_of(record));
    children.siblings = 0u;
    return children;
}

FUNC TreePosition at_next_of_visits(uint visits, uint first)
{
    ChildSlots slots = slots_of_visits(visits, first);
    uint slot = next_slot(visits);
    TreePosition at = at_record(child_index(slots, slot));
    if ((slots.mask >> slot & 0x100u) == 0u) at.item = at.item | LEAF_BIT;
    return at;
}

FUNC EnteredChildren children_of_wide(CompressedRecord record, CompressedRecord second_half, SwTree tree, BoxRay ray,
                                      Search search, uint target)
{
    uint visits = enter_wide(record, second_half, ray, search.t_min, search.t_best);
    if (target != NOTHING)
        visits = visits_from(visits, slot_towards(tree.records, child_slots(record, second_half), target));
    EnteredChildren children;
    children.siblings = first_child_of(record);
    children.first = at_next_of_visits(visits, children.siblings);
    children.is_entered = (visits & 0xffu) != 0u;
    children.others = rest_of_visits(visits);
    return children;
}

FUNC uint enter_binary_box(vec3 lo, vec3 hi, BoxRay ray, Search search, uint query)
{
    vec2 crossing = cross_box(lo, hi, ray, search.t_min, search.t_best);
    return visit_order(crossing.x, crossing.y, true, query);
}

FUNC ChildKeys enter_binary(BvhNode node, BoxRay ray, Search search, uint query)
{
    ChildKeys keys;
    keys.key0 = enter_binary_box(node.lo0, node.hi0, ray, search, query);
    keys.key1 = enter_binary_box(node.lo1, node.hi1, ray, search, query) | 1u;
    keys.key2 = NO_ENTRY;
    keys.key3 = NO_ENTRY;
    return keys;
}

// Below which child of `node` the edge `target` lies.
FUNC uint binary_child_towards(REF(BvhNode) nodes, uint node, uint target)
{
    uint edge = target;
    while (parent_of_edge(edge) != node) edge = edge_of(nodes, parent_of_edge(edge));
    return edge & 1u;
}

FUNC EnteredChildren children_of_node(uint index, SwTree tree, BoxRay ray, Search search, uint target,
                                         TraceOptions options)
{
    BvhNode node = load_node(tree.nodes, index);
    ChildKeys keys = enter_binary(node, ray, search, options.query);
    if (target != NOTHING) keys = keys_from(keys, binary_child_towards(tree.nodes, index, target));
    sort_pair(keys.key0, keys.key1);
    uint side = keys.key0 & 1u;
    EnteredChildren children;
    children.first.item = child_of(node, side).child;
    children.first.edge = make_edge(index, side);
    children.is_entered = keys.key0 < NO_ENTRY;
    children.others = keys.key1 < NO_ENTRY ? make_edge(index, side ^ 1u) : EMPTY_NODE_GROUP;
    children.siblings = 0u;
    return children;
}
#endif
