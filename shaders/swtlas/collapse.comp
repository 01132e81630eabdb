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

CollapseStep step_of(uint i)
{
    if (STEP == COLLAPSE_ROOTS)
    {
        if (i < args.tree_count) return begin_collapse(AT(args.trees, i), args.places, i);
    }
    else if (i < AT(args.level, 0).count)
    {
        CollapseItem item = AT(args.items, i);
        if (STEP == COLLAPSE_LEVEL) return collapse(AT(args.trees, item.tree), args.places, item);
        collapse_all(item);
    }
    return no_step();
}

void push(CollapseStep found)
{
    uint count = 0u;
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u) count = count + (found.is_inner[i] ? 1u : 0u);
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
    place = place + pushed_before;
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        if (!found.is_inner[i]) continue;
        AT(args.next_items, place) = found.items[i];
        place = place + 1u;
    }
}

void main()
{
    CollapseStep found = step_of(global_index());
    if (STEP != COLLAPSE_REST) push(found);
}
