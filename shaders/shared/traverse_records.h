// SPDX-License-Identifier: MIT
// Traversal of a SwScene of layout compressed4 or bvh4: one loop over nodes, primitives and instances, one record an
// iteration.
#ifndef TWINRAY_SHARED_TRAVERSE_RECORDS_H
#define TWINRAY_SHARED_TRAVERSE_RECORDS_H
#include "shaders/shared/enter_compressed.h"
#include "shaders/shared/enter_full.h"

FUNC ChildKeys enter_children(CompressedRecord node, REF(LeafBox) boxes, BoxRay ray, Search search, TraceOptions options)
{
    bool may_be_full = (options.features & FEATURE_BVH4) != 0u;
    bool may_be_compressed = (options.features & FEATURE_COMPRESSED) != 0u;
    if (may_be_full && (!may_be_compressed || uint64_t(boxes) != 0ul))
        return enter_full(boxes, node, ray, search.t_min, search.t_best, options.query);
    return enter_compressed(node, ray, search.t_min, search.t_best, options.query);
}

const uint IN_NO_INSTANCE = 0xffffffffu; // more groups than a stack ever has

FUNC Hit traverse_records(SwScene scene, Ray ray, TraceOptions options)
{
    Search search = begin_search(ray);
    bool has_top = (options.features & FEATURE_INSTANCES) != 0u;
    RaySpace space;
    REF(CompressedRecord) records = scene.records;
    REF(LeafBox) boxes = scene.record_boxes;
    InInstance inside;
    bool is_traced = is_traceable(ray);
    if (has_top)
    {
        is_traced = is_traced && scene.bvh.root != NOTHING;
        space = world_space(scene, ray);
        inside.custom_index = 0u;
    }
    else
    {
        SwInstance instance = load_instance(scene.instances, 0u);
        is_traced = is_traced && is_visible(instance, options);
        inside = enter_instance(instance, 0u, options);
        space = space_in(instance, inside, ray, options);
        records = instance.records;
        boxes = instance.record_boxes;
    }

    BoxRay first_ray = box_ray(space);
    HeldGroups held = hold_none(BOTTOM);
    GroupWindow window = empty_window();
    uint stack[TWINRAY_GROUP_STACK];
    uint height = 0u;
    uint waiting = 0u;             // groups on the stack
    uint outside = IN_NO_INSTANCE; // how many were there when the ray entered the instance that it is in
    uint cursor = 0u;
    // Conditions on which a ray is not traced are in the loop's: drivers on CPUs run a loop in a branch more slowly.
    while (is_traced)
    {
        CompressedRecord record = load_record(records, cursor);
        bool descend = false;
        uint pushed = EMPTY_GROUP;
        if (!is_leaf(record))
        {
            BoxRay ray_of_boxes = first_ray;
            if (has_top) ray_of_boxes = box_ray(space);
            ChildKeys keys = enter_children(record, boxes, ray_of_boxes, search, options);
            sort_keys(keys);
            uint others = group_of(keys, first_child_of(record));
            pushed = keys.key1 < NO_ENTRY ? others : EMPTY_GROUP;
            cursor = first_child_of(record) + (keys.key0 & 3u);
            descend = keys.key0 < NO_ENTRY;
        }
        else if (!has_top || !is_instance(record))
        {
            if (visit_leaf(primitive_of(record), inside, space, options, search) && options.query == QUERY_ANY) break;
        }
        else
        {
            uint index = index_in(record);
            SwInstance instance = load_instance(scene.instances, index);
            if (is_visible(instance, options))
            {
                inside = enter_instance(instance, index, options);
                space = space_in(instance, inside, ray, options);
                records = instance.records;
                boxes = instance.record_boxes;
                outside = waiting;
                cursor = 0u;
                descend = true;
            }
        }
        if (!descend)
        {
            if (has_top && waiting == outside)
            {
                space = world_space(scene, ray);
                records = scene.records;
                boxes = scene.record_boxes;
                outside = IN_NO_INSTANCE;
            }
            uint group = held.first;
            // Among instances some ray nearly always has one elsewhere, and another branch would be one more.
            if (has_top || lies_elsewhere(group))
            {
                TWINRAY_FETCH_GROUP(held, window, stack, height, group)
            }
            if (group == BOTTOM) break;
            cursor = next_of(group);
            held.first = rest_of(group);
        }
        TWINRAY_MAKE_ROOM(held, window, stack, height, pushed)
        if (has_top) waiting = waiting_after(held, pushed, waiting);
        shift_groups(held, pushed);
    }
    return hit_of(search, scene, inside.custom_index, options);
}
#endif
