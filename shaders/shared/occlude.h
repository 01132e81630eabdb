// SPDX-License-Identifier: MIT
// Whether triangles stop a ray, for rays that need not know where.
#ifndef TWINRAY_SHARED_OCCLUDE_H
#define TWINRAY_SHARED_OCCLUDE_H
#include "shaders/shared/intersect.h"

// What is known of t, as crossing() rounds it, without a division; where nothing is, only crossing() tells.
struct HitInterval
{
    bool is_after; // t > t_min
    bool is_before; // t < t_max
    bool is_behind; // t < t_min
};

// t is N / D: D the sum of the areas, N that of areas times t of their vertices. With m = (|a.x| + |b.x| + |c.x|)
// (|a.y| + |b.y| + |c.y|), which is no less than the products in the areas together, and u = 2^-24, areas are off by 3
// u m in all, N - t_min D is by 9 u m (t_most + t_min), t_most being the sum of the vertices' t, and t of crossing() by
// 30 u m t_most / D, with 2.5 ulp for a division, as Vulkan allows. 64 u cover both where nothing overflows, and no
// product is among the smallest floats.
FUNC HitInterval hit_interval(SeenTriangle seen, float shear_z, float t_min, float t_max)
{
    const float ROUNDINGS = 3.814697265625e-06f;         // 64 u
    // 2^-50: two of them times 64 u is 2^8 times the least normal float
    const float SMALLEST = 8.8817841970012523e-16f;
    const float LARGEST = 1.152921504606846976e+18f;     // 2^60
    const float LEAST_DEPTH = 7.8886090522101181e-31f;   // 2^-100: crossing() takes shares of vertices' z
    // 2^100, for infinity, which would make the bound infinite, too
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
    bool is_in_range = most > SMALLEST && most < LARGEST && t_most > SMALLEST && t_most < LARGEST &&
        z_most > LEAST_DEPTH;
    HitInterval interval;
    interval.is_after = is_in_range && past_start > start_bound;
    interval.is_before = is_in_range && to_end > unit * (t_most + t_end);
    interval.is_behind = is_in_range && past_start < -start_bound;
    return interval;
}

// Whether intersect_seen() finds a hit with t_min < t < t_max, the `ends`, 0 <= t_min, and then TriangleHit::along.
// False with sign_of_t asked: not known yet. That t costs as much as the rest of the test; here it is computed only
// where rounding hides its sign or on which side of an end it is.
FUNC bool seen_occludes(INOUT(SeenTriangle) seen, RaySpace space, vec2 ends, INOUT(uint) sign_of_t, INOUT(bool) along)
{
    float t_min = ends.x;
    float t_max = ends.y;
    bool is_met = is_around_ray(seen);
    bool is_hidden = is_met && may_begin_in_plane(seen);
    HitInterval interval = hit_interval(seen, space.shear_z, t_min, t_max);
    bool is_within = interval.is_after && interval.is_before;
    along = (seen.area_a + seen.area_b + seen.area_c > 0.0f) == (space.shear_z > 0.0f);
    if (is_hidden || (is_met && !is_within && !interval.is_behind))
    {
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
