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

shared uint pushed;
shared uint pushed_before;

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

// Where the group's next `count` items go. Barriers come before what a level writes: they would wait for it.
uint reserve(uint count)
{
    if (gl_LocalInvocationID.x == 0u) pushed = 0u;
    barrier();
    uint place = atomicAdd(pushed, count);
    barrier();
    if (gl_LocalInvocationID.x == 0u && pushed != 0u)
    {
        pushed_before = atomicAdd(AT(args.level, 1).count, pushed);
        uint groups = (pushed_before + pushed + COLLAPSE_GROUP - 1u) / COLLAPSE_GROUP;
        atomicMax(AT(args.level, 1).groups_x, min(groups, GROUPS_PER_ROW));
        atomicMax(AT(args.level, 1).groups_y, (groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW);
    }
    barrier();
    return place + pushed_before;
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
    CollapseStep found = no_step();
    if (index < args.tree_count) found = begin_collapse(AT(args.trees, index), args.places, index);
    push(found, reserve(found.is_inner[0] ? 1u : 0u));
}

void do_level(uint index)
{
    bool is_item = index < AT(args.level, 0).count;
    CollapseItem item = load_item(args.items, is_item ? index : 0u);
    BuildTree tree = AT(args.trees, item.tree);
    NodeChildren children = no_children();
    if (is_item) children = children_of(tree.nodes, item.place);
    uint place = reserve(inner_among(children));
    if (is_item) push(write_node(tree, args.places, item, children), place);
}

void main()
{
    uint index = global_index();
    if (STEP == COLLAPSE_ROOTS) begin(index);
    else if (STEP == COLLAPSE_LEVEL) do_level(index);
    else if (index < AT(args.level, 0).count) collapse_all(load_item(args.items, index));
}
