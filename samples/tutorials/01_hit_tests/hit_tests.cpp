// SPDX-License-Identifier: MIT
// Tutorial 1: one triangle, one ray, then a batch of rays; the fields of a hit, any hits and masks.
// [headers]
#include <cmath>
#include <filesystem>
#include <iostream>
#include <vector>

#include <twinray/scene.h>  // write_png
#include <twinray/tlas.h>   // the accelerators

using namespace twinray;

// [window]
// Rays straight down on a window of the plane z = 0, one through the middle of each pixel, row 0 on top.
constexpr uint width = 640, height = 480;
constexpr float window_width = 2, window_height = 1.5f, left = -0.4f, top = 1.4f;

std::vector<Ray> rays_of_window() {
    std::vector<Ray> rays;
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x)
            rays.push_back({.origin = vec3(left + window_width * (float(x) + 0.5f) / width,
                                           top - window_height * (float(y) + 0.5f) / height, 2),
                            .t_min = 0,
                            .direction = vec3(0, 0, -1),
                            .t_max = INFINITY});
    return rays;
}

// [color]
// The weights of the three corners as red, green and blue; instance 1 paler.
Rgb color_of(const Hit& hit) {
    if (hit.hit == 0) return {255, 255, 255};
    const vec3 weights(1 - hit.u - hit.v, hit.u, hit.v);
    const float white = hit.instance_index == 1 ? 0.6f : 0.1f;
    const auto mixed = [&](float weight) { return white + (1 - white) * weight; };
    return rgb_of_linear({mixed(weights.x), mixed(weights.y), mixed(weights.z)});
}

std::size_t count(const std::vector<Hit>& hits) {
    std::size_t found = 0;
    for (const Hit& hit : hits) found += hit.hit;
    return found;
}
// [/color]

int main(int argc, char** argv) try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    // [triangle]
    Mesh triangle;
    triangle.name = "triangle";
    triangle.positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
    triangle.triangles = {uvec3(0, 1, 2)};

    Context context;
    SwTlas accel(context);
    accel.push(triangle, {}, {.custom_index = 10, .mask = 0b01});

    // [ray]
    const Ray ray{.origin = vec3(0.25f, 0.5f, 2), .t_min = 0, .direction = vec3(0, 0, -1), .t_max = INFINITY};
    const Hit hit = accel.closest_hits({&ray, 1}).front();
    std::cout << "the ray meets instance " << hit.instance_index << ", triangle " << hit.primitive_index
              << " at t = " << hit.t << ", u = " << hit.u << ", v = " << hit.v << ", custom index " << hit.custom_index
              << '\n';

    // [miss]
    const Ray short_ray{.origin = ray.origin, .t_min = 0, .direction = ray.direction, .t_max = 1.5f};
    const Hit none = accel.closest_hits({&short_ray, 1}).front();
    std::cout << "the same ray up to t = 1.5 " << (none.hit ? "hits" : "misses") << ", t = " << none.t << '\n';

    // [second]
    accel.push(triangle, Transform::translation({0.2f, 0.3f, -1}), {.custom_index = 20, .mask = 0b10});

    // [batch]
    const std::vector<Ray> rays = rays_of_window();
    const std::vector<Hit> hits = accel.closest_hits(rays);
    const double area = double(count(hits)) / double(rays.size()) * window_width * window_height;
    std::cout << count(hits) << " of " << rays.size() << " rays hit: an area of " << area << ", by geometry 0.875\n";
    std::vector<Rgb> pixels;
    for (const Hit& of_ray : hits) pixels.push_back(color_of(of_ray));
    write_png(folder / "01_hit_tests.png", width, height, pixels);

    // [any]
    const std::vector<Hit> blocked = accel.any_hits(rays, {.occlusion_only = true});
    std::cout << "blocked, by any hits: " << count(blocked) << '\n';

    // [masks]
    constexpr std::uint8_t masks[] = {0b01, 0b10, 0b11};
    for (const std::uint8_t mask : masks) {
        const Hit seen = accel.closest_hits({&ray, 1}, {.mask = mask}).front();
        std::cout << "mask " << +mask << " sees custom index " << seen.custom_index << " at t = " << seen.t << '\n';
    }
    // [/masks]
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
