// SPDX-License-Identifier: MIT
// The ray tracer of tutorial 2, without its main: a scene, a camera and one bounce of all rays.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <twinray/scene.h>
#include <twinray/tlas.h>
#include "twinray/glsl/vector_math.h"  // arithmetic on vectors, by GLM

using namespace twinray;

// [scene]
// A floor and three balls. Their custom indices name their looks.
inline void push_balls(AbstractAccel& accel) {
    accel.push(make_quad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18}), {}, {.custom_index = 0});
    const Transform places[] = {Transform::translation({-2.1f, 1, 0}), Transform::translation({0, 1, -0.6f}),
                                Transform::translation({2.1f, 1, 0})};
    const InstanceOptions options[] = {{.custom_index = 1}, {.custom_index = 2}, {.custom_index = 3}};
    accel.push(make_icosphere(5), places, options);
}

// [materials]
struct Look {
    vec3 color;
    float mirror;  // the part of light that is reflected as by a mirror
};
const Look looks[] = {{vec3(0.8f, 0.8f, 0.75f), 0.1f},
                      {vec3(0.9f, 0.2f, 0.1f), 0.15f},
                      {vec3(0.95f), 0.8f},
                      {vec3(0.1f, 0.3f, 0.8f), 0.15f}};
const vec3 sun = normalize(vec3(0.6f, 1, 0.5f));  // the direction to it
inline vec3 sky(vec3 direction) { return mix(vec3(0.9f), vec3(0.35f, 0.55f, 0.9f), std::max(0.0f, direction.y)); }

// [camera]
// A ray for each pixel, through a place in it: (0.5, 0.5) is its middle.
inline std::vector<Ray> camera_rays(uint width, uint height, vec2 in_pixel = vec2(0.5f)) {
    const ImagePlane plane =
        image_plane(look_camera({0, 2.2f, 6.5f}, {0, 0.7f, 0}, {0, 1, 0}, 48), float(width) / float(height));
    std::vector<Ray> rays;
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x)
            rays.push_back(ray_through(plane, {2 * (float(x) + in_pixel.x) / float(width) - 1,
                                               1 - 2 * (float(y) + in_pixel.y) / float(height)}));
    return rays;
}

// [paths]
// A ray on its way: the pixel that it belongs to, and how much of its light gets there.
struct Path {
    uint pixel;
    float weight;
};

inline std::vector<Path> paths_of(const std::vector<Ray>& camera_rays) {
    std::vector<Path> paths;
    for (uint pixel = 0; pixel < camera_rays.size(); ++pixel) paths.push_back({pixel, 1});
    return paths;
}

// [leave]
// A ray that leaves a surface without meeting it again: it starts beside it by a bound of all rounding errors.
inline Ray leave(const Surface& surface, vec3 direction) {
    const float side = dot(direction, surface.point.normal) > 0 ? 1.0f : -1.0f;
    return {surface.point.position + surface.point.normal * (side * surface.point.offset), 0, direction, INFINITY};
}

// [bounce]
// Adds the light of the rays to the picture, and returns the rays and paths that continue: those off mirrors.
inline void bounce(AbstractAccel& accel, vec3 to_sun, std::vector<Ray>& rays, std::vector<Path>& paths,
                   std::vector<vec3>& picture) {
    const std::vector<Hit> hits = accel.closest_hits(rays);
    const std::vector<Surface> surfaces = accel.surfaces(rays, hits);
    std::vector<Ray> shadow_rays;
    for (const Surface& surface : surfaces) shadow_rays.push_back(leave(surface, to_sun));
    const std::vector<Hit> shadows = accel.any_hits(shadow_rays, {.occlusion_only = true});
    std::vector<Ray> next_rays;
    std::vector<Path> next_paths;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Path path = paths[i];
        const vec3 direction = normalize(rays[i].direction);
        if (!surfaces[i].is_hit) {
            picture[path.pixel] += sky(direction) * path.weight;
            continue;
        }
        const Look& look = looks[surfaces[i].custom_index];
        const float light = shadows[i].hit ? 0.0f : std::max(0.0f, dot(surfaces[i].normal, to_sun));
        picture[path.pixel] += look.color * (path.weight * (1 - look.mirror) * (0.2f + 0.8f * light));
        const vec3 mirrored = reflect(direction, surfaces[i].normal);
        if (dot(mirrored, surfaces[i].point.normal) <= 0) continue;  // into the triangle, at a grazing angle
        next_rays.push_back(leave(surfaces[i], mirrored));
        next_paths.push_back({path.pixel, path.weight * look.mirror});
    }
    rays = std::move(next_rays);
    paths = std::move(next_paths);
}
// [/bounce]

inline void write_picture(const std::filesystem::path& file, uint width, uint height, const std::vector<vec3>& light) {
    std::vector<Rgb> pixels;
    for (const vec3& linear : light) pixels.push_back(rgb_of_linear(linear));
    write_png(file, width, height, pixels);
}
