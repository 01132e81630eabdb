// SPDX-License-Identifier: MIT
// Binary trees become trees of four children a node, level by level: the items of one level leave those of the next.
// Begun once per tree; the last dispatch does what is left, each invocation a subtree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/collapse.h"
layout(local_size_x = BUILD_GROUP) in;
layout(constant_id = 0) const uint STEP = COLLAPSE_LEVEL;
layout(push_constant, scalar) uniform Push { CollapseArgs args; };

shared uint pushed;
shared uint pushed_before;

// Of one subtree, depth first.
void collapse_all(CollapseItem item)
{
    CollapseItem stack[3u * DEEPEST_TREE];
    uint height = 0u;
    BuildTree tree = AT(args.trees, item.tree);
    for (;;)
    {
        CollapseStep done = collapse(tree, item);
        for (uint i = 0u; i < done.count; i = i + 1u) stack[height + i] = done.items[i];
        height = height + done.count;
        if (height == 0u) return;
        height = height - 1u;
        item = stack[height];
    }
}

CollapseStep step_of(uint i)
{
    if (STEP == COLLAPSE_ROOTS)
    {
        if (i < args.tree_count) return begin_collapse(AT(args.trees, i), i);
    }
    else if (i < AT(args.level, 0).count)
    {
        CollapseItem item = AT(args.items, i);
        if (STEP == COLLAPSE_LEVEL) return collapse(AT(args.trees, item.tree), item);
        collapse_all(item);
    }
    CollapseStep nothing;
    nothing.count = 0u;
    return nothing;
}

void push(CollapseStep found)
{
    if (gl_LocalInvocationIndex == 0u) pushed = 0u;
    barrier();
    uint before = atomicAdd(pushed, found.count);
    barrier();
    if (gl_LocalInvocationIndex == 0u && pushed != 0u)
    {
        pushed_before = atomicAdd(AT(args.level, 1).count, pushed);
        atomicMax(AT(args.level, 1).groups_x, (pushed_before + pushed + BUILD_GROUP - 1u) / BUILD_GROUP);
    }
    barrier();
    for (uint i = 0u; i < found.count; i = i + 1u)
        AT(args.next_items, pushed_before + before + i) = found.items[i];
}

void main()
{
    CollapseStep found = step_of(global_index());
    if (STEP != COLLAPSE_REST) push(found);
}
