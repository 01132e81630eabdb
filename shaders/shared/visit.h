// SPDX-License-Identifier: MIT
// The part of a traversal of a SwTlasHeader that all layouts share, at primitives: the ray in the space of an instance,
// or of the top level, the needed data of the instance that it is in, and its finds so far.
#ifndef TWINRAY_SHARED_VISIT_H
#define TWINRAY_SHARED_VISIT_H
#include "shaders/shared/leaf_visit.h"
#include "shaders/shared/ray_space.h"
#include "shaders/shared/trace.h"
#ifdef TWINRAY_REFINED
#include "shaders/shared/certified.h"
#endif

// Rounding of the world-to-object transform moves a ray by a few roundings of its origin's size, and the limit of
// reciprocals by 2^-40 of the way. `extent`: the largest coordinate of the scene.
FUNC float world_pad(vec3 origin, float extent) {
    return largest_entry(origin) * 9.5367431640625e-07f + extent * 3.637978807091713e-12f;  // 2^-20, 2^-38
}

// Returns the side of an instance's triangles that is hidden from a ray: CULL_FRONT, CULL_BACK or 0.
FUNC uint culled_side(uint ray_flags, uint instance_flags) {
    uint side = ray_flags & (CULL_BACK | CULL_FRONT);
    if (side == 0u || (instance_flags & INSTANCE_DISABLE_CULLING) != 0u) return 0u;
    return (instance_flags & INSTANCE_FLIP_FACING) != 0u ? side ^ (CULL_BACK | CULL_FRONT) : side;
}

// The data of the current instance that traversal needs. Features are tested where these are read, not where they are
// set: only so do compilers see across the loop that dependent code never runs.
struct InInstance {
    uint index;
    uint custom_index;
    uint culled;  // side of its triangles that is not hit
    bool has_boxes;
    bool is_non_opaque;
    bool is_flipped;  // culling takes the back of its triangles for the front
    float error;      // at LEVEL_CERTIFIED: see CertifiedRay; else 0
};

FUNC InInstance enter_instance(SwInstance instance, uint index, TraceOptions options) {
    InInstance inside;
    inside.index = index;
    inside.custom_index = instance.custom_index_mask & 0xffffffu;
    inside.culled = culled_side(options.flags, instance.flags);
    inside.has_boxes = instance.kind == GEOMETRY_BOXES;
    inside.error = 0.0f;
    inside.is_flipped = (instance.flags & INSTANCE_FLIP_FACING) != 0u;
    inside.is_non_opaque = (instance.flags & INSTANCE_NON_OPAQUE) != 0u || (options.flags & ALL_NON_OPAQUE) != 0u;
    return inside;
}

FUNC InInstance in_no_instance() {
    InInstance inside;
    inside.index = NOTHING;
    inside.custom_index = 0u;
    inside.culled = 0u;
    inside.has_boxes = false;
    inside.is_non_opaque = false;
    inside.is_flipped = false;
    inside.error = 0.0f;
    return inside;
}

// Adding 0 removes a zero's sign, which the sums of a transform may change: so both ways give the same bits with the
// identity.
FUNC vec3 without_negative_zeros(vec3 v) {
    PRECISE vec3 sum = v + vec3(0.0f);
    return sum;
}

// A ray in the space of a tree, and how far off its boxes may be met (see make_ray_space).
struct LocalRay {
    vec3 origin;
    vec3 direction;
    float pad;
};

FUNC LocalRay ray_in_world(SwTlasHeader scene, Ray ray) {
    LocalRay local;
    local.origin = ray.origin;
    local.direction = ray.direction;
    local.pad = world_pad(ray.origin, largest_coordinate(scene.bvh.lo, scene.bvh.hi));
    return local;
}

FUNC RaySpace space_of(LocalRay ray) { return make_ray_space(ray.origin, ray.direction, ray.pad); }

// Returns the ray in the space of the instance's geometry.
FUNC LocalRay ray_in_instance(SwInstance instance, INOUT(InInstance) inside, Ray ray, TraceOptions options) {
    LocalRay local;
#ifdef TWINRAY_REFINED
    if (options.level == LEVEL_CERTIFIED) {
        CertifiedRay mapped = certified_ray(AT(options.instances, inside.index), ray, options.advance != double(0.0f));
        inside.error = mapped.error;
        local.origin = mapped.origin;
        local.direction = mapped.direction;
        local.pad = mapped.error;
        return local;
    }
#endif
    vec3 origin = ray.origin;
    vec3 direction = ray.direction;
    if ((options.features & FEATURE_TRANSFORMS) != 0u) {
        origin = transform_point(instance.world_to_object, origin);
        direction = transform_vector(instance.world_to_object, direction);
    }
    local.origin = without_negative_zeros(origin);
    local.direction = without_negative_zeros(direction);
    local.pad = vertex_pad(local.origin, instance.extent);
    return local;
}

// The best hit so far, and the interval in which closer ones may be. Only the fields that a kernel needs are ever
// written: the rest stay constants, which compilers see through the loop.
struct Search {
    float t_min;
    float t_best;
    float t_best_low;  // see TriangleHit::t_low; of a limit 0
    float u;
    float v;
    uint primitive_index;  // NOTHING: no hit so far
    uint instance_index;
    bool along;      // see TriangleHit
    uint sign_of_t;  // SIGN_*, of the triangle that is visited
};

FUNC Search begin_search(Ray ray) {
    Search search;
    search.t_min = ray.t_min > 0.0f ? ray.t_min : 0.0f;
    search.t_best = ray.t_max;
    search.t_best_low = 0.0f;
    search.u = 0.0f;
    search.v = 0.0f;
    search.primitive_index = NOTHING;
    search.instance_index = 0u;
    search.along = false;
    search.sign_of_t = SIGN_UNASKED;
    return search;
}

FUNC Candidate candidate_of(InInstance inside, uint primitive_index, bool is_front, TraceOptions options) {
    Candidate candidate;
    candidate.primitive_index = primitive_index;
    candidate.instance_index = inside.index;
    candidate.custom_index = inside.custom_index;
    candidate.is_front = is_front;
    candidate.user_data = options.user_data;
    return candidate;
}

FUNC bool intersect_box(LeafVisit leaf, InInstance inside, RaySpace space, Search search, TraceOptions options,
                        INOUT(TriangleHit) hit) {
    float enter = 0.0f;
    if (!enter_box(leaf.primitive.v0, leaf.primitive.v1, space, search.t_min, search.t_best, enter)) return false;
    Ray ray_local;
    ray_local.origin = space.origin;
    ray_local.direction = space.direction;
    ray_local.t_min = search.t_min;
    ray_local.t_max = search.t_best;
    vec2 uv = vec2(0.0f);
    hit.t = 0.0f;
    hit.t_low = 0.0f;
    hit.along = false;
    bool is_met = intersect_primitive(candidate_of(inside, leaf.primitive_index, false, options), ray_local, hit.t, uv);
    hit.u = uv.x;
    hit.v = uv.y;
    return is_met;
}

FUNC bool has_box(InInstance inside, TraceOptions options) {
    return (options.features & FEATURE_BOXES) != 0u && inside.has_boxes;
}

// Returns whether the ray's line meets the primitive on a side that counts, and where. It and the next two return at
// one place: so they are inlined, and a kernel is given to a driver without the code that its constants rule out.
FUNC bool intersect_leaf(LeafVisit leaf, InInstance inside, RaySpace space, TraceOptions options, INOUT(Search) search,
                         INOUT(TriangleHit) hit) {
    bool is_met = false;
    bool is_culled = false;
    if (has_box(inside, options))
        is_met = intersect_box(leaf, inside, space, search, options, hit);
    else {
#ifdef TWINRAY_REFINED
        if (options.level == LEVEL_CERTIFIED)
            is_met = intersect_in_world(leaf.primitive_index, inside.index, options, search.sign_of_t, hit);
        else
#endif
            if (options.level == LEVEL_FAST)
            is_met = intersect_triangle_fast(leaf.primitive.v0, leaf.primitive.v1, leaf.primitive.v2, space, hit);
        else
            is_met = intersect_seen(leaf.seen, space, search.sign_of_t, hit);
        if ((options.features & FEATURE_CULLING) != 0u)
            is_culled = inside.culled == (hit.along ? CULL_BACK : CULL_FRONT);
    }
    return is_met && !is_culled;
}

FUNC bool comes_after(TriangleHit hit, float t_min, TraceOptions options) {
    bool is_after = hit.t > t_min;
    if (options.level == LEVEL_CERTIFIED) is_after = is_after || (hit.t == t_min && hit.t_low > 0.0f);
    return is_after;
}

const uint NO_ENTRY = 0x7f800000u;  // infinity and above: no hit is reported there

// Returns the rank among its siblings of a box that the ray crosses from `enter` to `leave`, the least first; the last
// two bits are free. The nearest is first; if any hit will do, that in which the ray is longest, as most may be hit
// there. (Larger boxes first, for rays unknown: Nah, Manocha, "SATO: Surface Area Traversal Order for Shadow Ray
// Tracing", 2014.)
FUNC uint visit_order(float enter, float leave, bool is_there, uint query) {
    uint longest_first = 0x7f000000u - min(floatBitsToUint(leave - enter), 0x7e000000u);
    uint key = query == QUERY_ANY ? longest_first : floatBitsToUint(enter);
    return is_there && enter <= leave ? key & 0x7ffffffcu : NO_ENTRY;  // of zeros the sign may be either
}

FUNC Hit hit_of(Search search, SwTlasHeader scene, TraceOptions options) {
    Hit hit = miss();
    if (search.primitive_index == NOTHING) return hit;
    InInstance inside = enter_instance(AT(scene.instances, search.instance_index), search.instance_index, options);
    bool is_box = has_box(inside, options);
    hit.hit = 1u;
    hit.t = search.t_best;
    hit.u = search.u;
    hit.v = search.v;
    hit.primitive_index = search.primitive_index;
    hit.instance_index = search.instance_index;
    hit.custom_index = inside.custom_index;
    hit.flags = search.along == inside.is_flipped && !is_box ? HIT_FRONT : 0u;
    return hit;
}

// Returns whether the hit comes before the best one of the search: by t, then by (instance, primitive).
FUNC bool comes_before(TriangleHit hit, uint instance_index, uint primitive_index, Search search,
                       TraceOptions options) {
    bool is_lower = primitive_index < search.primitive_index;
    if ((options.features & FEATURE_INSTANCES) != 0u)
        is_lower = instance_index < search.instance_index || (instance_index == search.instance_index && is_lower);
    is_lower = is_lower && search.primitive_index != NOTHING;
    if (options.level == LEVEL_CERTIFIED)
        is_lower = hit.t_low < search.t_best_low || (hit.t_low == search.t_best_low && is_lower);
    return hit.t < search.t_best || (hit.t == search.t_best && is_lower);
}

// Returns whether the primitive is hit before all earlier hits.
FUNC bool find_in_leaf(LeafVisit leaf, InInstance inside, RaySpace space, TraceOptions options, INOUT(Search) search) {
    TriangleHit hit;
    hit.t = 0.0f;
    hit.t_low = 0.0f;
    hit.u = 0.0f;
    hit.v = 0.0f;
    hit.along = false;
    bool is_first = false;
    if (intersect_leaf(leaf, inside, space, options, search, hit)) {
        is_first = comes_after(hit, search.t_min, options) &&
                   comes_before(hit, inside.index, leaf.primitive_index, search, options);
        if ((options.features & FEATURE_FILTERS) != 0u && is_first && inside.is_non_opaque) {
            bool is_front = hit.along == inside.is_flipped && !inside.has_boxes;
            is_first = accept_hit(candidate_of(inside, leaf.primitive_index, is_front, options),
                                  t_of_given(hit.t, options), vec2(hit.u, hit.v));
        }
        if (is_first) {
            search.t_best = hit.t;
            if (options.level == LEVEL_CERTIFIED) search.t_best_low = hit.t_low;
            search.u = hit.u;
            search.v = hit.v;
            search.along = hit.along;
            search.primitive_index = leaf.primitive_index;
            if ((options.features & FEATURE_INSTANCES) != 0u) search.instance_index = inside.index;
        }
    }
    return is_first;
}

FUNC bool leaf_occludes(LeafVisit leaf, InInstance inside, RaySpace space, TraceOptions options, INOUT(Search) search) {
    bool along = false;
    bool occludes = seen_occludes(leaf.seen, space, vec2(search.t_min, search.t_best), search.sign_of_t, along);
    if ((options.features & FEATURE_CULLING) != 0u)
        occludes = occludes && (inside.culled == 0u || inside.culled != (along ? CULL_BACK : CULL_FRONT));
    if (occludes) search.primitive_index = leaf.primitive_index;
    if ((options.features & FEATURE_INSTANCES) != 0u && occludes) search.instance_index = inside.index;
    return occludes;
}

// The same; for triangles, without t, u, v if only the answer is wanted.
FUNC bool visit_leaf(LeafVisit leaf, InInstance inside, RaySpace space, TraceOptions options, INOUT(Search) search) {
    const uint NEEDS_HIT = FEATURE_HITS | FEATURE_FILTERS | FEATURE_BOXES;
    // Each is separate, so that compilers see constants.
    bool is_any = options.query == QUERY_ANY;
    bool is_answer_enough = (options.features & NEEDS_HIT) == 0u;
    bool is_exact = options.level == LEVEL_WATERTIGHT || options.level == LEVEL_REFINED;
    bool is_first = false;
    if (is_any && is_answer_enough && is_exact)
        is_first = leaf_occludes(leaf, inside, space, options, search);
    else
        is_first = find_in_leaf(leaf, inside, space, options, search);
    return is_first;
}

FUNC bool is_visible(REF(SwInstance) instances, uint index, TraceOptions options) {
    uint mask = AT(instances, index).custom_index_mask >> 24u;
    bool is_seen = (options.features & FEATURE_MASKS) == 0u || (mask & options.mask) != 0u;
    return is_seen && AT(instances, index).root != NOTHING;
}
#endif
