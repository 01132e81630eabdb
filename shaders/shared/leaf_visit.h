// SPDX-License-Identifier: MIT
// A ray visits one primitive of a leaf, as seen from its origin. If two triangles share an edge, it visits the one that
// its line may cross, and both, one after the other, only if it may cross both. A ray that only needs to know whether
// it is stopped does not compute where.
#ifndef TWINRAY_SHARED_LEAF_VISIT_H
#define TWINRAY_SHARED_LEAF_VISIT_H
#include "shaders/shared/compressed.h"
#include "shaders/shared/intersect.h"
#ifdef TWINRAY_REFINED
#include "shaders/shared/certified.h"
#endif

struct LeafVisit {
    SeenTriangle seen;      // at levels watertight and refined
    BvhTriangle primitive;  // at level fast, and of boxes
    uint primitive_index;
    bool is_second;
    bool is_missed;    // the ray surely misses all of the leaf
    bool is_followed;  // the leaf's second triangle must be visited next
};

// The vertices of a leaf as a ray sees them, and twice the signed areas between the ray and each edge; a shared edge is
// computed once.
struct SeenLeaf {
    vec3 begin;
    vec3 end;
    vec3 third[2];        // of the first, of the second
    float shared_area;    // of begin, end
    float to_third[2];    // of end, third
    float from_third[2];  // of third, begin
};

FUNC SeenLeaf seen_leaf(LeafVertices vertices, RaySpace space) {
    SeenLeaf seen;
    seen.begin = sheared(vertices.begin, space);
    seen.end = sheared(vertices.end, space);
    seen.third[0] = sheared(vertices.first, space);
    seen.third[1] = sheared(vertices.second, space);
    seen.shared_area = edge_function(seen.begin, seen.end);
    UNROLL for (uint i = 0u; i < 2u; i = i + 1u) {
        seen.to_third[i] = edge_function(seen.end, seen.third[i]);
        seen.from_third[i] = edge_function(seen.third[i], seen.begin);
    }
    return seen;
}

// Gives the same bits as seen_triangle().
FUNC SeenTriangle triangle_in(SeenLeaf leaf, uint corners, bool is_second) {
    // An area goes with the corner across its edge. Turned around, edges change places and signs.
    bool is_flipped = is_second && (corners & PAIR_FLIPPED) != 0u;
    float sign = is_flipped ? -1.0f : 1.0f;
    float to_third = is_second ? leaf.to_third[1] : leaf.to_third[0];
    float from_third = is_second ? leaf.from_third[1] : leaf.from_third[0];
    OrderedCorners ordered =
        ordered_corners(corners, is_second, vec4(is_second ? leaf.third[1] : leaf.third[0], sign * leaf.shared_area),
                        vec4(leaf.begin, sign * to_third), vec4(leaf.end, sign * from_third));
    SeenTriangle seen;
    seen.a = vec3(ordered.a.x, ordered.a.y, ordered.a.z);
    seen.b = vec3(ordered.b.x, ordered.b.y, ordered.b.z);
    seen.c = vec3(ordered.c.x, ordered.c.y, ordered.c.z);
    seen.area_a = ordered.a.w;
    seen.area_b = ordered.b.w;
    seen.area_c = ordered.c.w;
    return seen;
}

// Returns false only if is_around_ray() does.
FUNC bool may_be_around_ray(float area_a, float area_b, float area_c) {
    bool is_met = (area_a < 0.0f) == (area_b < 0.0f) && (area_b < 0.0f) == (area_c < 0.0f);
    return is_met || is_any_zero(area_a, area_b, area_c);
}

// Returns the triangles that the ray's line may meet, as bits 0 and 1.
FUNC uint triangles_around_ray(SeenLeaf leaf) {
    bool is_first = may_be_around_ray(leaf.shared_area, leaf.to_third[0], leaf.from_third[0]);
    bool is_second = may_be_around_ray(leaf.shared_area, leaf.to_third[1], leaf.from_third[1]);
    return (is_first ? 1u : 0u) | (is_second ? 2u : 0u);
}

#ifdef TWINRAY_REFINED
// The same for level certified, whose sheared vertices are off by `error`.
FUNC bool may_be_certified(SeenLeaf leaf, uint i, float error) {
    int shared_side = certain_side(leaf.begin, leaf.end, error);
    int to_third = certain_side(leaf.end, leaf.third[i], error);
    int from_third = certain_side(leaf.third[i], leaf.begin, error);
    return shared_side * to_third >= 0 && to_third * from_third >= 0 && from_third * shared_side >= 0;
}
FUNC uint triangles_to_certify(SeenLeaf leaf, float error) {
    return (may_be_certified(leaf, 0u, error) ? 1u : 0u) | (may_be_certified(leaf, 1u, error) ? 2u : 0u);
}
#endif

// The same for level fast, which tests each triangle by itself.
FUNC bool may_be_hit_fast(LeafVertices vertices, bool is_second, RaySpace space) {
    BvhTriangle t = primitive_in(vertices, is_second);
    TriangleHit hit;
    return intersect_triangle_fast(t.v0, t.v1, t.v2, space, hit);
}
FUNC uint triangles_hit_fast(LeafVertices vertices, RaySpace space) {
    if (vertices.there == 1u) return 1u;  // tested by the visit
    return (may_be_hit_fast(vertices, false, space) ? 1u : 0u) | (may_be_hit_fast(vertices, true, space) ? 2u : 0u);
}

// `comes_second`: the first triangle was visited. `error`: see CertifiedRay.
FUNC LeafVisit visit_in_leaf(LeafVertices vertices, bool comes_second, bool has_box, RaySpace space, float error,
                             uint level) {
    SeenLeaf seen;
    if (level != LEVEL_FAST) seen = seen_leaf(vertices, space);
    uint visits = 0u;
    if (has_box)
        visits = 1u;
    else if (level == LEVEL_FAST)
        visits = triangles_hit_fast(vertices, space);
#ifdef TWINRAY_REFINED
    else if (level == LEVEL_CERTIFIED)
        visits = triangles_to_certify(seen, error);
#endif
    else
        visits = triangles_around_ray(seen);
    visits = visits & vertices.there & (comes_second ? 2u : 3u);
    LeafVisit visit;
    visit.is_second = (visits & 1u) == 0u;
    visit.is_missed = visits == 0u;
    visit.is_followed = visits == 3u;
    if (level == LEVEL_FAST || has_box) visit.primitive = primitive_in(vertices, visit.is_second);
    if (level != LEVEL_FAST) visit.seen = triangle_in(seen, vertices.corners, visit.is_second);
    visit.primitive_index = visit.is_second ? vertices.primitives.y : vertices.primitives.x;
    return visit;
}

// Bounds of t, as crossing() rounds it, found without a division; without a bound, only crossing() tells.
struct HitInterval {
    bool is_after;   // t > t_min
    bool is_before;  // t < t_max
    bool is_behind;  // t < t_min
};

// t is N / D: D the sum of the areas, N that of areas times t of their vertices. With m = (|a.x| + |b.x| + |c.x|)
// (|a.y| + |b.y| + |c.y|), which is no less than the products in the areas together, and u = 2^-24, areas are off by 3
// u m in all, N - t_min D is by 9 u m (t_most + t_min), t_most being the sum of the vertices' t, and t of crossing() by
// 30 u m t_most / D, with 2.5 ulp for a division, as Vulkan allows. 64 u cover both where nothing overflows, and no
// product is among the smallest floats.
FUNC HitInterval hit_interval(SeenTriangle seen, float shear_z, float t_min, float t_max) {
    const float ROUNDINGS = 3.814697265625e-06f;  // 64 u
    // 2^-50: two of them times 64 u is 2^8 times the least normal float
    const float SMALLEST = 8.8817841970012523e-16f;
    const float LARGEST = 1.152921504606846976e+18f;    // 2^60
    const float LEAST_DEPTH = 7.8886090522101181e-31f;  // 2^-100: crossing() takes shares of vertices' z
    // 2^100, for infinity, which would also make the bound infinite
    const float FARTHEST = 1.2676506002282294e+30f;
    vec3 t = vec3(seen.a.z, seen.b.z, seen.c.z) * shear_z;
    float det = seen.area_a + seen.area_b + seen.area_c;
    float weighted = seen.area_a * t.x + seen.area_b * t.y + seen.area_c * t.z;
    float width = abs(seen.a.x) + abs(seen.b.x) + abs(seen.c.x);
    float height = abs(seen.a.y) + abs(seen.b.y) + abs(seen.c.y);
    float most = width * height;
    float z_most = abs(seen.a.z) + abs(seen.b.z) + abs(seen.c.z);
    float t_most = z_most * abs(shear_z);
    float t_end = t_max < FARTHEST ? t_max : FARTHEST;
    float past_start = det < 0.0f ? t_min * det - weighted : weighted - t_min * det;
    float to_end = det < 0.0f ? weighted - t_end * det : t_end * det - weighted;
    float unit = most * ROUNDINGS;
    float start_bound = unit * (t_most + t_min);
    bool is_in_range =
        most > SMALLEST && most < LARGEST && t_most > SMALLEST && t_most < LARGEST && z_most > LEAST_DEPTH;
    HitInterval interval;
    interval.is_after = is_in_range && past_start > start_bound;
    interval.is_before = is_in_range && to_end > unit * (t_most + t_end);
    interval.is_behind = is_in_range && past_start < -start_bound;
    return interval;
}

// Returns whether intersect_seen() finds a hit with t_min < t < t_max, the `ends`, 0 <= t_min, and then
// TriangleHit::along. Returns false with sign_of_t asked if it is not known yet. That t costs as much as the rest of
// the test; here it is computed only if rounding hides its sign or its side of an end.
FUNC bool seen_occludes(INOUT(SeenTriangle) seen, RaySpace space, vec2 ends, INOUT(uint) sign_of_t, INOUT(bool) along) {
    float t_min = ends.x;
    float t_max = ends.y;
    bool is_met = is_around_ray(seen);
    bool is_hidden = is_met && may_begin_in_plane(seen);
    HitInterval interval = hit_interval(seen, space.shear_z, t_min, t_max);
    bool is_within = interval.is_after && interval.is_before;
    along = (seen.area_a + seen.area_b + seen.area_c > 0.0f) == (space.shear_z > 0.0f);
    if (is_hidden || (is_met && !is_within && !interval.is_behind)) {
        TriangleHit hit = crossing(seen.a, seen.b, seen.c, space.shear_z);
        bool asks = is_hidden && sign_of_t == SIGN_UNASKED;
        float t = signed_t(hit.t, sign_of_t);
        along = hit.along;
        if (asks) sign_of_t = asked_sign(hit.along);
        is_within = !asks && t > t_min && t < t_max;
    }
    return is_met && is_within;
}
#endif
