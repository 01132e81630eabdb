// SPDX-License-Identifier: MIT
// Tutorial 2: a ray tracer in 100 lines, by batches from the host: shading, shadows, reflections.
#include <cmath>
#include <filesystem>
#include <iostream>
#include <vector>

#include <twinray/scene.h>
#include <twinray/tlas.h>
#include "twinray/glsl/vector_math.h"  // arithmetic on vectors, by GLM

using namespace twinray;

namespace {

constexpr uint width = 640, height = 480;

// [materials]
struct Look {
    vec3 color;
    float mirror;  // the part of light that is reflected as by a mirror
};
const Look looks[] = {{vec3(0.8f, 0.8f, 0.75f), 0.1f},
                      {vec3(0.9f, 0.2f, 0.1f), 0.15f},
                      {vec3(0.95f), 0.8f},
                      {vec3(0.1f, 0.3f, 0.8f), 0.15f}};
// [/materials]

// [paths]
// A ray on its way: the pixel that it belongs to, and how much of its light gets there.
struct Path {
    uint pixel;
    float weight;
};
// [/paths]

// [camera]
std::vector<Ray> camera_rays() {
    const ImagePlane plane =
        image_plane(look_camera({0, 2.2f, 6.5f}, {0, 0.7f, 0}, {0, 1, 0}, 48), float(width) / height);
    std::vector<Ray> rays;
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x)
            rays.push_back(ray_through(plane, {2 * (float(x) + 0.5f) / width - 1, 1 - 2 * (float(y) + 0.5f) / height}));
    return rays;
}
// [/camera]

vec3 sky(vec3 direction) { return mix(vec3(0.9f), vec3(0.35f, 0.55f, 0.9f), std::max(0.0f, normalize(direction).y)); }

// [leave]
// A ray that leaves a surface without meeting it again: it starts beside it by a bound of all rounding errors.
Ray leave(const Surface& surface, vec3 direction) {
    const float side = dot(direction, surface.point.normal) > 0 ? 1.0f : -1.0f;
    return {surface.point.position + surface.point.normal * (side * surface.point.offset), 0, direction, INFINITY};
}
// [/leave]

// [bounce]
// Adds to the picture what the rays bring, and gives the rays and paths that are left: those off mirrors.
void bounce(AbstractAccel& accel, std::vector<Ray>& rays, std::vector<Path>& paths, std::vector<vec3>& picture) {
    const vec3 to_sun = normalize(vec3(0.6f, 1, 0.5f));
    const std::vector<Hit> hits = accel.closest_hits(rays);
    const std::vector<Surface> surfaces = accel.surfaces(rays, hits);
    std::vector<Ray> shadow_rays;
    for (const Surface& surface : surfaces) shadow_rays.push_back(leave(surface, to_sun));
    const std::vector<Hit> shadows = accel.any_hits(shadow_rays, {.occlusion_only = true});
    std::vector<Ray> next_rays;
    std::vector<Path> next_paths;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Path path = paths[i];
        if (!surfaces[i].is_hit) {
            picture[path.pixel] += sky(rays[i].direction) * path.weight;
            continue;
        }
        const Look& look = looks[surfaces[i].custom_index];
        const float sun = shadows[i].hit ? 0.0f : std::max(0.0f, dot(surfaces[i].normal, to_sun));
        picture[path.pixel] += look.color * (path.weight * (1 - look.mirror) * (0.2f + 0.8f * sun));
        const vec3 direction = reflect(normalize(rays[i].direction), surfaces[i].normal);
        if (dot(direction, surfaces[i].point.normal) <= 0) continue;  // into the triangle, at a grazing angle
        next_rays.push_back(leave(surfaces[i], direction));
        next_paths.push_back({path.pixel, path.weight * look.mirror});
    }
    rays = std::move(next_rays);
    paths = std::move(next_paths);
}
// [/bounce]

}  // namespace

int main(int argc, char** argv) try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    // [scene]
    Context context;
    SwTlas accel(context, {.keeps_surfaces = true});
    accel.push(make_quad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18}), {}, {.custom_index = 0});
    const Transform places[] = {Transform::translation({-2.1f, 1, 0}), Transform::translation({0, 1, -0.6f}),
                                Transform::translation({2.1f, 1, 0})};
    const InstanceOptions options[] = {{.custom_index = 1}, {.custom_index = 2}, {.custom_index = 3}};
    accel.push(make_icosphere(5), places, options);
    // [/scene]

    // [loop]
    std::vector<vec3> picture(std::size_t(width) * height, vec3(0));
    std::vector<Ray> rays = camera_rays();
    std::vector<Path> paths;
    for (uint pixel = 0; pixel < width * height; ++pixel) paths.push_back({pixel, 1});
    for (int depth = 0; depth < 4 && !rays.empty(); ++depth) {
        std::cout << "bounce " << depth << ": " << rays.size() << " rays\n";
        bounce(accel, rays, paths, picture);
    }
    std::vector<Rgb> pixels;
    for (const vec3& light : picture) pixels.push_back(rgb_of_linear(light));
    write_png(folder / "02_ray_tracer.png", width, height, pixels);
    // [/loop]

    // [check]
    // From a point above the floor towards the sun: the middle of the red sphere is in the way.
    const Ray down{
        .origin = vec3(-2.625f, 0.125f, -0.4375f), .t_min = 0, .direction = vec3(0.6f, 1, 0.5f), .t_max = INFINITY};
    std::cout << "the shadow is dark: " << (accel.any_hits({&down, 1}).front().hit ? "yes" : "no") << '\n';
    // [/check]
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
