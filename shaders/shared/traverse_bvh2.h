// SPDX-License-Identifier: MIT
// Traversal of a SwScene of layout bvh2: one loop over both levels, one stack.
#ifndef TWINRAY_SHARED_TRAVERSE_BVH2_H
#define TWINRAY_SHARED_TRAVERSE_BVH2_H
#include "shaders/shared/visit.h"

// Each inner node on a path leaves at most one entry: those of both levels, the mark between them and the bottom.
const uint STACK_SIZE = 2u * DEEPEST_TREE + 4u;

const uint END_OF_STACK = 0xffffffffu;   // == NOTHING: an empty scene ends at once
const uint END_OF_INSTANCE = 0xfffffffeu;

FUNC uint place_of(vec3 lo, vec3 hi, BoxRay ray, Search search, uint query)
{
    float enter = 0.0f;
    float leave = 0.0f;
    cross_box(lo, hi, ray, search.t_min, search.t_best, enter, leave);
    return place_in_order(enter, leave, true, query);
}

FUNC Hit traverse_bvh2(SwScene scene, Ray ray, TraceOptions options)
{
    Search search = begin_search(ray);
    bool has_top = (options.features & FEATURE_INSTANCES) != 0u;
    RaySpace space;
    REF(BvhNode) nodes = scene.bvh.nodes;
    REF(BvhTriangle) triangles = REF(BvhTriangle)(0ul);
    InInstance inside;
    uint cursor = scene.bvh.root;
    bool is_traced = is_traceable(ray);
    if (has_top)
    {
        space = world_space(scene, ray);
        inside.custom_index = 0u;
    }
    else
    {
        SwInstance instance = load_instance(scene.instances, 0u);
        is_traced = is_traced && is_visible(instance, options);
        inside = enter_instance(instance, 0u, options);
        space = space_in(instance, inside, ray, options);
        nodes = instance.nodes;
        triangles = instance.triangles;
        cursor = instance.root;
    }
    bool in_instance = !has_top;

    BoxRay first_ray = box_ray(space);
    uint stack[STACK_SIZE];
    uint height = 1u;
    stack[0] = END_OF_STACK;
    while (is_traced && cursor != END_OF_STACK)
    {
        bool descend = false;
        if ((cursor & LEAF_BIT) == 0u)
        {
            BvhNode node = load_node(nodes, cursor);
            BoxRay ray_of_boxes = first_ray;
            if (has_top) ray_of_boxes = box_ray(space);
            uint place0 = place_of(node.lo0, node.hi0, ray_of_boxes, search, options.query);
            uint place1 = place_of(node.lo1, node.hi1, ray_of_boxes, search, options.query);
            bool hit0 = place0 < NO_ENTRY;
            bool hit1 = place1 < NO_ENTRY;
            bool first_is_0 = place0 <= place1;
            cursor = first_is_0 ? node.child0 : node.child1;
            if (hit0 && hit1)
            {
                stack[height] = first_is_0 ? node.child1 : node.child0;
                height = height + 1u;
            }
            descend = hit0 || hit1;
        }
        else if (!has_top || in_instance)
        {
            BvhTriangle leaf = load_triangle(triangles, cursor & ~LEAF_BIT);
            if (visit_leaf(leaf, inside, space, options, search) && options.query == QUERY_ANY) break;
        }
        else
        {
            uint index = cursor & ~LEAF_BIT;
            SwInstance instance = load_instance(scene.instances, index);
            if (is_visible(instance, options))
            {
                inside = enter_instance(instance, index, options);
                space = space_in(instance, inside, ray, options);
                nodes = instance.nodes;
                triangles = instance.triangles;
                stack[height] = END_OF_INSTANCE;
                height = height + 1u;
                in_instance = true;
                cursor = instance.root;
                descend = true;
            }
        }
        if (!descend)
        {
            height = height - 1u;
            cursor = stack[height];
            if (has_top && cursor == END_OF_INSTANCE)
            {
                space = world_space(scene, ray);
                nodes = scene.bvh.nodes;
                in_instance = false;
                height = height - 1u;
                cursor = stack[height];
            }
        }
    }
    return hit_of(search, scene, inside.custom_index, options);
}
#endif
