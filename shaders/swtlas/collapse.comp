// SPDX-License-Identifier: MIT
// Binary trees become trees of four children a node, level by level: the items of one level leave those of the next.
// Begun once per tree; the last dispatch does what is left, each invocation a subtree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/collapse.h"
layout(local_size_x = COLLAPSE_GROUP) in;
layout(constant_id = 0) const uint STEP = COLLAPSE_LEVEL;
layout(push_constant, scalar) uniform Push { CollapseArgs args; };

// Of one subtree, depth first.
void collapse_all(CollapseItem item)
{
    CollapseItem stack[3u * DEEPEST_RECORDS];
    uint height = 0u;
    BuildTree tree = AT(args.trees, item.tree);
    for (;;)
    {
        CollapseStep done = collapse(tree, args.places, item);
        UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
        {
            if (!done.is_inner[i]) continue;
            stack[height] = done.items[i];
            height = height + 1u;
        }
        if (height == 0u) return;
        height = height - 1u;
        item = stack[height];
    }
}

// Where the next level has room for `count` more items. Whoever begins its last group so far says how many groups it has.
uint reserve(uint count)
{
    if (count == 0u) return 0u;
    uint place = atomicAdd(AT(args.level, 1).count, count);
    uint groups_before = (place + COLLAPSE_GROUP - 1u) / COLLAPSE_GROUP;
    uint groups = (place + count + COLLAPSE_GROUP - 1u) / COLLAPSE_GROUP;
    if (groups == groups_before) return place;
    atomicMax(AT(args.level, 1).groups_x, min(groups, GROUPS_PER_ROW));
    atomicMax(AT(args.level, 1).groups_y, (groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW);
    return place;
}

void push(CollapseStep found, uint place)
{
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        if (!found.is_inner[i]) continue;
        store_item(args.next_items, place, found.items[i]);
        place = place + 1u;
    }
}

void begin(uint index)
{
    if (index >= args.tree_count) return;
    CollapseStep found = begin_collapse(AT(args.trees, index), args.places, index);
    push(found, reserve(found.is_inner[0] ? 1u : 0u));
}

void do_item(CollapseItem item)
{
    BuildTree tree = AT(args.trees, item.tree);
    NodeChildren children = children_of(tree.nodes, item.place);
    uint place = reserve(inner_among(children)); // before all writes, which an atomic operation waits for on CPUs
    push(write_node(tree, args.places, item, children), place);
}

void main()
{
    uint index = global_index();
    if (STEP == COLLAPSE_ROOTS)
    {
        begin(index);
        return;
    }
    if (index >= AT(args.level, 0).count) return;
    CollapseItem item = load_item(args.items, index);
    if (STEP == COLLAPSE_LEVEL) do_item(item);
    else collapse_all(item);
}
