// SPDX-License-Identifier: MIT
// Traversal of a SwScene: one loop over both levels, one stack.
#ifndef TWINRAY_SHARED_TRAVERSE_H
#define TWINRAY_SHARED_TRAVERSE_H
#include "shaders/shared/bvh.h"
#include "shaders/shared/intersect.h"
#include "shaders/shared/transform.h"

// Inner nodes on a path split on ever lower bits of (30-bit Morton code, 24-bit position), so a path has at most 54,
// and each leaves at most one entry on the stack: 54 for each level, the mark between them and the bottom.
const uint STACK_SIZE = 112u;

const uint END_OF_STACK = 0xffffffffu;   // == NOTHING: an empty scene ends at once
const uint END_OF_INSTANCE = 0xfffffffeu;

// Rounding of the world-to-object transform moves a ray by a few roundings of its origin's size.
FUNC float world_pad(vec3 origin) { return largest_entry(origin) * 9.5367431640625e-07f; } // 2^-20

FUNC BvhNode load_node(REF(BvhNode) nodes, uint index)
{
    // Fetched in 64-bit components: drivers on CPUs pay per component, not per byte.
    Words64 words = Words64(uint64_t(nodes) + uint64_t(index) * 64ul);
    uint64_t w0 = AT(words, 0), w1 = AT(words, 1), w2 = AT(words, 2), w3 = AT(words, 3);
    uint64_t w4 = AT(words, 4), w5 = AT(words, 5), w6 = AT(words, 6), w7 = AT(words, 7);
    BvhNode node;
    node.lo0 = vec3(FLOATS(w0).x, FLOATS(w0).y, FLOATS(w1).x);
    node.child0 = UINTS(w1).y;
    node.hi0 = vec3(FLOATS(w2).x, FLOATS(w2).y, FLOATS(w3).x);
    node.child1 = UINTS(w3).y;
    node.lo1 = vec3(FLOATS(w4).x, FLOATS(w4).y, FLOATS(w5).x);
    node.first = UINTS(w5).y;
    node.hi1 = vec3(FLOATS(w6).x, FLOATS(w6).y, FLOATS(w7).x);
    node.last = UINTS(w7).y;
    return node;
}

FUNC BvhTriangle load_triangle(REF(BvhTriangle) triangles, uint index)
{
    Words64 words = Words64(uint64_t(triangles) + uint64_t(index) * 40ul);
    uint64_t w0 = AT(words, 0), w1 = AT(words, 1), w2 = AT(words, 2), w3 = AT(words, 3), w4 = AT(words, 4);
    BvhTriangle triangle;
    triangle.v0 = vec3(FLOATS(w0).x, FLOATS(w0).y, FLOATS(w1).x);
    triangle.v1 = vec3(FLOATS(w1).y, FLOATS(w2).x, FLOATS(w2).y);
    triangle.v2 = vec3(FLOATS(w3).x, FLOATS(w3).y, FLOATS(w4).x);
    triangle.primitive_index = UINTS(w4).y;
    return triangle;
}

// Which side an instance's triangles hide from a ray: CULL_FRONT, CULL_BACK or 0.
FUNC uint culled_side(uint ray_flags, uint instance_flags)
{
    uint side = ray_flags & (CULL_BACK | CULL_FRONT);
    if (side == 0u || (instance_flags & INSTANCE_NO_CULLING) != 0u) return 0u;
    return (instance_flags & INSTANCE_TURNED) != 0u ? side ^ (CULL_BACK | CULL_FRONT) : side;
}

// Traces a ray through the instances whose mask shares a bit with `mask`; flags: CULL_BACK or CULL_FRONT or 0. The closest hit is the one with smallest t,
// then lowest (instance, primitive), whatever the order of traversal; with QUERY_ANY it is the first one found.
FUNC Hit traverse(SwScene scene, Ray ray, uint mask, uint flags, uint query)
{
    Hit best = miss();
    if (!is_traceable(ray)) return best;
    float t_min = ray.t_min > 0.0f ? ray.t_min : 0.0f;
    float t_best = ray.t_max;
    RaySpace space = make_ray_space(ray.origin, ray.direction, world_pad(ray.origin));
    REF(BvhNode) nodes = scene.bvh.nodes;
    REF(BvhTriangle) triangles = REF(BvhTriangle)(0ul);
    bool in_instance = false;
    uint instance_index = 0u;
    uint custom_index = 0u;
    uint culled = 0u;

    uint stack[STACK_SIZE];
    uint height = 1u;
    stack[0] = END_OF_STACK;
    uint cursor = scene.bvh.root;
    while (cursor != END_OF_STACK)
    {
        bool descend = false;
        if ((cursor & LEAF_BIT) == 0u)
        {
            BvhNode node = load_node(nodes, cursor);
            float enter0 = 0.0f;
            float enter1 = 0.0f;
            bool hit0 = enter_box(node.lo0, node.hi0, space, t_min, t_best, enter0);
            bool hit1 = enter_box(node.lo1, node.hi1, space, t_min, t_best, enter1);
            bool first_is_0 = hit0 && (!hit1 || enter0 <= enter1);
            cursor = first_is_0 ? node.child0 : node.child1;
            if (hit0 && hit1)
            {
                stack[height] = first_is_0 ? node.child1 : node.child0;
                height = height + 1u;
            }
            descend = hit0 || hit1;
        }
        else if (in_instance)
        {
            BvhTriangle triangle = load_triangle(triangles, cursor & ~LEAF_BIT);
            TriangleHit hit;
            if (intersect_triangle(triangle.v0, triangle.v1, triangle.v2, space, hit) && hit.t > t_min &&
                (culled == 0u || culled != (hit.along ? CULL_BACK : CULL_FRONT)))
            {
                bool lower = best.hit != 0u && (instance_index < best.instance_index ||
                             (instance_index == best.instance_index && triangle.primitive_index < best.primitive_index));
                if (hit.t < t_best || (hit.t == t_best && lower))
                {
                    t_best = hit.t;
                    best.hit = 1u;
                    best.t = hit.t;
                    best.u = hit.u;
                    best.v = hit.v;
                    best.primitive_index = triangle.primitive_index;
                    best.instance_index = instance_index;
                    best.custom_index = custom_index;
                    if (query == QUERY_ANY) break;
                }
            }
        }
        else
        {
            instance_index = cursor & ~LEAF_BIT;
            SwInstance instance = AT(scene.instances, instance_index);
            bool visible = (instance.custom_index_mask >> 24u & mask) != 0u && instance.root != NOTHING;
            if (visible)
            {
                Rows to_object;
                to_object.r0 = instance.world_to_object[0];
                to_object.r1 = instance.world_to_object[1];
                to_object.r2 = instance.world_to_object[2];
                space = make_ray_space(transform_point(to_object, ray.origin), transform_vector(to_object, ray.direction), 0.0f);
                nodes = instance.nodes;
                triangles = instance.triangles;
                custom_index = instance.custom_index_mask & 0xffffffu;
                culled = culled_side(flags, instance.flags);
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
            if (cursor == END_OF_INSTANCE)
            {
                space = make_ray_space(ray.origin, ray.direction, world_pad(ray.origin));
                nodes = scene.bvh.nodes;
                in_instance = false;
                height = height - 1u;
                cursor = stack[height];
            }
        }
    }
    return best;
}
#endif
