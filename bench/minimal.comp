// SPDX-License-Identifier: MIT
// What a trace of one instance of triangles that stands as its mesh was given needs, at level watertight in layout
// compressed4, and nothing else: the mark that shaders/engine/trace.comp, specialised for that, must reach.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#define TWINRAY_GROUP_STACK ONE_LEVEL_STACK_SIZE
#include "shaders/shared/traverse_records.h"
layout(local_size_x = 64) in;
layout(constant_id = QUERY_CONSTANT) const uint MINIMAL_QUERY = QUERY_CLOSEST;
layout(push_constant, scalar) uniform Push { TraceArgs args; };

bool comes_first(TriangleHit hit, uint primitive_index, float t_min, float t_best, Hit best)
{
    bool is_lower = best.hit != 0u && primitive_index < best.primitive_index;
    return hit.t > t_min && (hit.t < t_best || (hit.t == t_best && is_lower));
}

Hit closest_triangle(SwInstance instance, Ray ray)
{
    Hit best = miss();
    if (!is_traceable(ray) || instance.root == NOTHING) return best;
    vec3 origin = without_negative_zeros(ray.origin);
    RaySpace space = make_ray_space(origin, without_negative_zeros(ray.direction), corner_pad(origin, instance.extent));
    float t_min = ray.t_min > 0.0f ? ray.t_min : 0.0f;
    float t_best = ray.t_max;
    HeldGroups held = no_groups();
    uint stack[TWINRAY_GROUP_STACK];
    uint height = 1u;
    stack[0] = BOTTOM;
    uint cursor = 0u;
    for (;;)
    {
        CompressedRecord record = load_record(instance.records, cursor);
        if (!is_leaf(record))
        {
            ChildKeys keys = enter_compressed(record, space, t_min, t_best, MINIMAL_QUERY);
            uint count = count_entered(keys);
            uint others = BOTTOM;
            order_children(keys, count, first_child_of(record), cursor, others);
            if (count > 1u) TWINRAY_PUSH_GROUP(held, stack, height, others)
            if (count > 0u) continue;
        }
        else
        {
            BvhTriangle triangle = primitive_of(record);
            TriangleHit hit;
            if (intersect_triangle(triangle.v0, triangle.v1, triangle.v2, space, hit) &&
                comes_first(hit, triangle.primitive_index, t_min, t_best, best))
            {
                t_best = hit.t;
                best.hit = 1u;
                best.t = hit.t;
                best.u = hit.u;
                best.v = hit.v;
                best.primitive_index = triangle.primitive_index;
                best.custom_index = instance.custom_index_mask & 0xffffffu;
                if (MINIMAL_QUERY == QUERY_ANY) break;
            }
        }
        uint group = held.first;
        if (group == BOTTOM)
        {
            height = height - 1u;
            group = stack[height];
            if (group == BOTTOM) break;
        }
        cursor = next_of(group);
        held.first = rest_of(group);
        if (held.first == BOTTOM) drop_group(held);
    }
    return best;
}

void main()
{
    uint i = global_index();
    if (i >= ray_count(args.count, args.indirect_count)) return;
    SwScene scene = AT(REF(SwScene)(args.scene), 0);
    Hit hit = closest_triangle(AT(scene.instances, 0), AT(args.rays, i));
    if (MINIMAL_QUERY == QUERY_CLOSEST) AT(args.hits, i) = hit;
    else AT(args.hits, i).hit = hit.hit;
}
