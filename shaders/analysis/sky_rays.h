// SPDX-License-Identifier: MIT
// Rays from points of faces to the sky or the sun.
#ifndef TWINRAY_ANALYSIS_SKY_RAYS_H
#define TWINRAY_ANALYSIS_SKY_RAYS_H
#include "shaders/analysis/count_faces.h"
#include "twinray/glsl/random.h"
#include "twinray/glsl/sampling.h"

const uint FACE_STREAM = 0x66616365u;

struct SkyRaysArgs {
    FaceTable table;
    REF(Ray) rays;  // `samples` of each face; one that leaves a side that does not count ends before it begins
    vec3 towards;   // the zenith or the sun; unit
    uint to_sun;    // 1: all rays go there; 0: to all of the sky above the horizon, by its contribution to the face
    uint front_only;
    uint first_face;
    uint ray_count;
    uint samples;
    uint rows;  // of strata, about sqrt(samples)
    uint stream;
    uint seed_low;
    uint seed_high;
};

struct CountFreeArgs {
    REF(Ray) rays;
    REF(Hit) hits;
    REF(GroupCount)
    counts;  // of each face: rays that begin and meet nothing; pairs are (2 i, 2 i + 1) of a face's rays
    uint first_face;
    uint samples;
    uint pair_count;  // ceil(samples / 2) of each face
    uint reserved;
};

// Returns the point u of stratum `index` of `count` with equal areas, which fill `rows` rows of the unit square.
FUNC vec2 in_stratum(uint index, uint count, uint rows, vec2 u) {
    uint row = index * rows / count;
    uint first = (row * count + rows - 1u) / rows;
    uint next = ((row + 1u) * count + rows - 1u) / rows;
    float columns = float(next - first);
    return vec2((float(index - first) + u.x) / columns, (float(first) + u.y * columns) / float(count));
}

FUNC Ray sky_ray(SkyRaysArgs args, uint index) {
    uint face = args.first_face + index / args.samples;
    uint number = index % args.samples;
    // Two hashes: a face has up to 2^20 rays, and the sun up to 2^32 positions.
    uvec4 words = random_words(uvec4(number, args.seed_low, args.seed_high, FACE_STREAM));
    words = random_words(uvec4(words.x, words.y, face, args.stream));
    vec2 first = in_stratum(number, args.samples, args.rows, unit_floats(uvec2(words.x, words.y)));
    vec2 second = unit_floats(uvec2(words.z, words.w));
    SurfacePoint point = point_on_face(args.table, face, sample_triangle(args.to_sun != 0u ? first : second));
    vec3 direction = args.towards;
    if (args.to_sun == 0u) {
        // The density is the cosine, over all of the sphere that is not below the horizon.
        direction = to_world(frame_about(point.normal), sample_cosine_hemisphere(first));
        if (dot(direction, args.towards) < 0.0f) direction = -direction;
    }
    bool is_front = dot(direction, point.normal) > 0.0f;
    Ray ray;
    ray.origin = spawn_position(point, is_front);
    ray.t_min = 0.0f;
    ray.direction = direction;
    bool counts = (is_front || args.front_only == 0u) && is_finite(ray.origin);
    ray.t_max = counts ? uintBitsToFloat(0x7f800000u) : -1.0f;
    return ray;
}
#endif
