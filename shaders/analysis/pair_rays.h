// SPDX-License-Identifier: MIT
// Rays between points of two faces, and their parts of the exchange.
#ifndef TWINRAY_ANALYSIS_PAIR_RAYS_H
#define TWINRAY_ANALYSIS_PAIR_RAYS_H
#include "shaders/analysis/view_factors.h"

// Rays between two faces: samples `first` to `first + SAMPLES_OF_CHUNK - 1` of each replicate, in the order of
// RayChunk.
struct PairChunk {
    uint a;
    uint b;
    uint first;
    float distance;  // of the faces, about; weights are in units of their values there
    FacePart part_a;
    FacePart part_b;
};
BUFFER_OF(PairChunk, 4);

struct PairRaysArgs {
    FaceTable table;
    REF(PairChunk) chunks;
    REF(Ray) rays;   // written
    Floats weights;  // written
    uint seed;
    uint sequence;  // SEQUENCE_*
    uint is_two_sided;
    uint reserved;
};

struct PairWeightsArgs {
    REF(Hit) hits;
    Floats weights;  // of blocked rays made negative
    uint count;
    uint reserved;
};

struct PairRay {
    // from a spawn point to the other: it meets all that is between; ends before it begins where `weight` is 0
    Ray ray;
    float weight;  // cos cos (distance / r)^2; 0 where a side that does not count is seen, half of it where both do
};

FUNC vec4 pair_sample_of(PairRaysArgs args, PairChunk chunk, uint replicate, uint index) {
    uvec4 key = random_words(uvec4(chunk.a, chunk.b, replicate, args.seed));
    uvec4 words;
    if (args.sequence == SEQUENCE_SOBOL)
        words = sobol_point(key, index);
    else
        words = random_words(uvec4(key.x, key.y, key.z, key.w ^ index));
    return vec4(unit_floats(uvec2(words.x, words.y)), unit_floats(uvec2(words.z, words.w)));
}

FUNC PairRay pair_ray(PairRaysArgs args, PairChunk chunk, vec4 u) {
    SurfacePoint a = inner_point(args.table, chunk.a, sample_part(chunk.part_a, vec2(u.x, u.y)));
    SurfacePoint b = inner_point(args.table, chunk.b, sample_part(chunk.part_b, vec2(u.z, u.w)));
    vec3 way = b.position - a.position;
    float r = scaled_length(way);
    float cos_a = dot(way, a.normal) / r;
    float cos_b = -dot(way, b.normal) / r;
    bool counts = r > 0.0f && (args.is_two_sided != 0u || (cos_a > 0.0f && cos_b > 0.0f));
    float ratio = chunk.distance / r;
    PairRay pair;
    pair.weight = counts ? abs(cos_a * cos_b) * ratio * ratio * (args.is_two_sided != 0u ? 0.5f : 1.0f) : 0.0f;
    pair.ray.origin = spawn_position(a, cos_a > 0.0f);
    pair.ray.t_min = 0.0f;
    pair.ray.direction = spawn_position(b, cos_b > 0.0f) - pair.ray.origin;
    pair.ray.t_max = pair.weight > 0.0f ? 1.0f : -1.0f;
    return pair;
}
#endif
