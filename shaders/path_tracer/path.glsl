// SPDX-License-Identifier: MIT
// The path that a ray belongs to, and the light that the ray finds by itself.
#ifndef TWINRAY_PATH_TRACER_PATH_GLSL
#define TWINRAY_PATH_TRACER_PATH_GLSL
#include "twinray/glsl/random.h"
#include "shaders/path_tracer/lights.glsl"

WaveData wave;  // kernels fill it in first

// The fields of PathQueue.
struct PathState {
    vec3 throughput;
    float pdf;
    uint pixel;
    uint progress;
    uint medium;  // of WaveData::media
    uint facing;  // of WaveData::facings
};

PathState load_path(uint i) {
    PathState path;
    path.throughput = AT(wave.paths.throughput, i);
    path.pdf = AT(wave.paths.pdf, i);
    path.pixel = AT(wave.paths.pixel, i);
    path.progress = AT(wave.paths.progress, i);
    path.medium = HAS_MEDIA ? AT(wave.media, i) : 0u;
    path.facing = HAS_LIGHT_TREE ? AT(wave.facings, i) : 0u;
    return path;
}

void go_on(Ray ray, PathState path) {
    uint slot = atomicAdd(AT(wave.counters, 0).paths, 1u);
    AT(wave.next_rays, slot) = ray;
    AT(wave.next_paths.throughput, slot) = path.throughput;
    AT(wave.next_paths.pdf, slot) = path.pdf;
    AT(wave.next_paths.pixel, slot) = path.pixel;
    AT(wave.next_paths.progress, slot) = path.progress;
    if (HAS_MEDIA) AT(wave.next_media, slot) = path.medium;
    if (HAS_LIGHT_TREE) AT(wave.next_facings, slot) = path.facing;
}

void add(uint pixel, vec3 radiance) {
    if (is_finite(radiance))
        AT(wave.sums, pixel).rgb += radiance;
    else
        atomicAdd(AT(wave.counters, 0).non_finite, 1u);
}

// Returns the weight of light that a ray sampled with density `own` has found, if light sampling has density `other`.
float found_weight(float own, float other) {
    if (STRATEGY == STRATEGY_BSDF) return 1.0;
    if (STRATEGY == STRATEGY_LIGHTS) return own > 0.0 && other > 0.0 ? 0.0 : 1.0;
    return mis_weight(own, other);
}

void add_environment(PathState path, Ray ray) {
    if (!HAS_ENVIRONMENT) return;
    Environment env = AT(wave.scene, 0).environment;
    vec2 at = environment_position(env, ray.direction);
    if (path.pdf > 0.0) {
        vec3 pixel = environment_pixel(env, int(at.x), int(at.y));
        add(path.pixel, path.throughput * pixel * found_weight(path.pdf, environment_pdf(env, pixel)));
    } else
        add(path.pixel, path.throughput * environment_seen(env, at));
}
#endif
