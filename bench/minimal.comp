// SPDX-License-Identifier: MIT
// What a trace of one instance of triangles that stands as its mesh was given needs, at level watertight in layout
// compressed4, and nothing else: the mark that shaders/engine/trace.comp, specialised for that, must reach.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#define TWINRAY_GROUP_STACK ONE_LEVEL_STACK_SIZE
#include "shaders/shared/traverse_records.h"
#include "shaders/shared/turns.h"
layout(local_size_x = 64, local_size_x_id = RAY_GROUP_CONSTANT) in;
layout(constant_id = QUERY_CONSTANT) const uint MINIMAL_QUERY = QUERY_CLOSEST;
layout(constant_id = HANDS_CONSTANT) const uint MINIMAL_HANDS = 0u;
layout(push_constant, scalar) uniform Push { TraceArgs args; };

Hit closest_triangle(SwInstance instance, Ray ray)
{
    bool is_traced = is_traceable(ray) && instance.root != NOTHING;
    vec3 origin = without_negative_zeros(ray.origin);
    RaySpace space = make_ray_space(origin, without_negative_zeros(ray.direction), corner_pad(origin, instance.extent));
    BoxRay ray_of_boxes = box_ray(space);
    float t_min = ray.t_min > 0.0f ? ray.t_min : 0.0f;
    float t_best = ray.t_max;
    float u = 0.0f;
    float v = 0.0f;
    uint primitive_index = NOTHING;
    HeldGroups held = hold_none(BOTTOM);
    GroupWindow window = empty_window();
    uint stack[TWINRAY_GROUP_STACK];
    uint height = 0u;
    uint cursor = 0u;
    while (is_traced)
    {
        CompressedRecord record = load_record(instance.records, cursor);
        bool descend = false;
        uint pushed = EMPTY_GROUP;
        if (!is_leaf(record))
        {
            ChildKeys keys = enter_compressed(record, ray_of_boxes, t_min, t_best, MINIMAL_QUERY);
            sort_keys(keys);
            uint others = group_of(keys, first_child_of(record));
            pushed = keys.key1 < NO_ENTRY ? others : EMPTY_GROUP;
            cursor = first_child_of(record) + (keys.key0 & 3u);
            descend = keys.key0 < NO_ENTRY;
        }
        else
        {
            BvhTriangle triangle = primitive_of(record);
            if (MINIMAL_QUERY == QUERY_ANY)
            {
                bool along = false;
                if (triangle_occludes(triangle.v0, triangle.v1, triangle.v2, space, t_min, t_best, along))
                {
                    primitive_index = triangle.primitive_index;
                    break;
                }
            }
            else
            {
                TriangleHit hit;
                if (intersect_triangle(triangle.v0, triangle.v1, triangle.v2, space, hit))
                {
                    bool is_lower = triangle.primitive_index < primitive_index && primitive_index != NOTHING;
                    if (hit.t > t_min && (hit.t < t_best || (hit.t == t_best && is_lower)))
                    {
                        t_best = hit.t;
                        u = hit.u;
                        v = hit.v;
                        primitive_index = triangle.primitive_index;
                    }
                }
            }
        }
        if (!descend)
        {
            uint group = held.first;
            if (lies_elsewhere(group))
            {
                TWINRAY_FETCH_GROUP(held, window, stack, height, group)
            }
            if (group == BOTTOM) break;
            cursor = next_of(group);
            held.first = rest_of(group);
        }
        TWINRAY_MAKE_ROOM(held, window, stack, height, pushed)
        shift_groups(held, pushed);
    }
    Hit best = miss();
    if (primitive_index == NOTHING) return best;
    best.hit = 1u;
    best.t = t_best;
    best.u = u;
    best.v = v;
    best.primitive_index = primitive_index;
    best.custom_index = instance.custom_index_mask & 0xffffffu;
    return best;
}

void main()
{
    uint count = ray_count(args.count, args.indirect_count);
    uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    uint size = gl_WorkGroupSize.x;
    uint run = MINIMAL_HANDS == 0u ? 1u : run_of_blocks(count, size, groups);
    uint first = dealt_group(group_index(), groups, MINIMAL_HANDS) * run * size + gl_LocalInvocationID.x;
    SwScene scene = AT(REF(SwScene)(args.scene), 0);
    bool has_turns = MINIMAL_HANDS != 0u && MINIMAL_QUERY == QUERY_CLOSEST;
    Turns turns = turns_as_given();
    for (uint k = 0u; k < run && first + k * size < count; ++k)
    {
        uint i = first + k * size;
        if (has_turns) i = ray_of_turn(turns, args, first, k, run, size, count);
        Hit hit = closest_triangle(AT(scene.instances, 0), load_ray(args.rays, i));
        if (MINIMAL_QUERY == QUERY_CLOSEST) store_hit(args.hits, i, hit);
        else AT(args.hits, i).hit = hit.hit;
    }
}
