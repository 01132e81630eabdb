// SPDX-License-Identifier: MIT
// Traversal of a SwScene: one loop over both levels, one stack.
#ifndef TWINRAY_SHARED_TRAVERSE_H
#define TWINRAY_SHARED_TRAVERSE_H
#include "shaders/shared/bvh.h"
#include "shaders/shared/intersect.h"
#include "shaders/shared/trace.h"
#include "shaders/shared/transform.h"
#ifdef TWINRAY_REFINED
#include "shaders/shared/certified.h"
#endif

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

// What traversal must know of the instance it is in.
struct InInstance
{
    uint index;
    uint custom_index;
    uint culled; // side of its triangles that is not hit
    bool has_boxes;
    bool is_filtered;
    float error; // at LEVEL_CERTIFIED: see CertifiedRay; else 0
};

FUNC InInstance enter_instance(SwInstance instance, uint index, TraceOptions options)
{
    InInstance inside;
    inside.index = index;
    inside.custom_index = instance.custom_index_mask & 0xffffffu;
    inside.culled = culled_side(options.flags, instance.flags);
    inside.has_boxes = (options.features & FEATURE_BOXES) != 0u && instance.kind == GEOMETRY_BOXES;
    inside.error = 0.0f;
    inside.is_filtered = (options.features & FEATURE_FILTERS) != 0u && (instance.flags & INSTANCE_FILTERED) != 0u;
    return inside;
}

// The ray in the space of the instance's geometry.
FUNC RaySpace space_in(SwInstance instance, INOUT(InInstance) inside, Ray ray, TraceOptions options)
{
#ifdef TWINRAY_REFINED
    if (options.level == LEVEL_CERTIFIED)
    {
        CertifiedRay mapped = certified_ray(AT(options.instances, inside.index), ray, options.advance != double(0.0f));
        inside.error = mapped.error;
        return make_ray_space(mapped.origin, mapped.direction, mapped.error);
    }
#endif
    Rows to_object;
    to_object.r0 = instance.world_to_object[0];
    to_object.r1 = instance.world_to_object[1];
    to_object.r2 = instance.world_to_object[2];
    vec3 origin = transform_point(to_object, ray.origin);
    return make_ray_space(origin, transform_vector(to_object, ray.direction), corner_pad(origin, instance.extent));
}

FUNC Candidate candidate_of(InInstance inside, uint primitive_index, TraceOptions options)
{
    Candidate candidate;
    candidate.primitive_index = primitive_index;
    candidate.instance_index = inside.index;
    candidate.custom_index = inside.custom_index;
    candidate.user_data = options.user_data;
    return candidate;
}

FUNC bool intersect_box(BvhTriangle box, InInstance inside, RaySpace space, float t_min, float t_best,
                        TraceOptions options, INOUT(TriangleHit) hit)
{
    float enter = 0.0f;
    if (!enter_box(box.v0, box.v1, space, t_min, t_best, enter)) return false;
    Ray ray_local;
    ray_local.origin = space.origin;
    ray_local.direction = space.direction;
    ray_local.t_min = t_min;
    ray_local.t_max = t_best;
    vec2 uv = vec2(0.0f);
    hit.t = 0.0f;
    hit.t_low = 0.0f;
    hit.along = false;
    bool is_met = intersect_primitive(candidate_of(inside, box.primitive_index, options), ray_local, hit.t, uv);
    hit.u = uv.x;
    hit.v = uv.y;
    return is_met;
}

// Whether the ray's line meets the primitive on a side that counts, and where.
FUNC bool intersect_leaf(BvhTriangle leaf, InInstance inside, RaySpace space, float t_min, float t_best,
                         TraceOptions options, INOUT(TriangleHit) hit)
{
    if (inside.has_boxes) return intersect_box(leaf, inside, space, t_min, t_best, options, hit);
    bool is_met = false;
#ifdef TWINRAY_REFINED
    if (options.level == LEVEL_CERTIFIED)
        is_met = intersect_certified(leaf, space, inside.error, inside.index, options, hit);
    else
#endif
    if (options.level == LEVEL_FAST) is_met = intersect_triangle_fast(leaf.v0, leaf.v1, leaf.v2, space, hit);
    else is_met = intersect_triangle(leaf.v0, leaf.v1, leaf.v2, space, hit);
    return is_met && (inside.culled == 0u || inside.culled != (hit.along ? CULL_BACK : CULL_FRONT));
}

// The order of hits: by t, then by (instance, primitive). `low`: see TriangleHit::t_low; of a limit 0.
FUNC bool comes_before(TriangleHit hit, uint instance_index, uint primitive_index, float t_best, float t_best_low, Hit best)
{
    bool is_lower = best.hit != 0u && (instance_index < best.instance_index ||
                    (instance_index == best.instance_index && primitive_index < best.primitive_index));
    return hit.t < t_best ||
           (hit.t == t_best && (hit.t_low < t_best_low || (hit.t_low == t_best_low && is_lower)));
}
FUNC bool comes_after(TriangleHit hit, float t_min) { return hit.t > t_min || (hit.t == t_min && hit.t_low > 0.0f); }

// Traces a ray. The closest hit is the first by comes_before, whatever the order of traversal; with QUERY_ANY it is the
// first one found.
FUNC Hit traverse(SwScene scene, Ray ray, TraceOptions options)
{
    Hit best = miss();
    if (!is_traceable(ray)) return best;
    float t_min = ray.t_min > 0.0f ? ray.t_min : 0.0f;
    float t_best = ray.t_max;
    float t_best_low = 0.0f;
    RaySpace space = make_ray_space(ray.origin, ray.direction, world_pad(ray.origin));
    REF(BvhNode) nodes = scene.bvh.nodes;
    REF(BvhTriangle) triangles = REF(BvhTriangle)(0ul);
    bool in_instance = false;
    InInstance inside;

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
            BvhTriangle leaf = load_triangle(triangles, cursor & ~LEAF_BIT);
            TriangleHit hit;
            if (intersect_leaf(leaf, inside, space, t_min, t_best, options, hit) && comes_after(hit, t_min) &&
                comes_before(hit, inside.index, leaf.primitive_index, t_best, t_best_low, best) &&
                (!inside.is_filtered ||
                 accept_hit(candidate_of(inside, leaf.primitive_index, options), t_of_given(hit.t, options),
                            vec2(hit.u, hit.v))))
            {
                t_best = hit.t;
                t_best_low = hit.t_low;
                best.hit = 1u;
                best.t = hit.t;
                best.u = hit.u;
                best.v = hit.v;
                best.primitive_index = leaf.primitive_index;
                best.instance_index = inside.index;
                best.custom_index = inside.custom_index;
                if (options.query == QUERY_ANY) break;
            }
        }
        else
        {
            uint index = cursor & ~LEAF_BIT;
            SwInstance instance = AT(scene.instances, index);
            bool visible = (instance.custom_index_mask >> 24u & options.mask) != 0u && instance.root != NOTHING;
            if (visible)
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
