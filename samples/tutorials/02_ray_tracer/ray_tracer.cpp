// SPDX-License-Identifier: MIT
// Tutorial 2: a ray tracer in 100 lines, by batches from the host: shading, shadows, reflections.
#include <filesystem>
#include <iostream>

#include "tracer.h"

int main(int argc, char** argv) try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    // [accel]
    Context context;
    SwTlas accel(context, {.keeps_surfaces = true});
    push_balls(accel);

    // [loop]
    const uint width = 640, height = 480;
    std::vector<vec3> picture(width * height, vec3(0));
    std::vector<Ray> rays = camera_rays(width, height);
    std::vector<Path> paths = paths_of(rays);
    for (int depth = 0; depth < 4 && !rays.empty(); ++depth) {
        std::cout << "bounce " << depth << ": " << rays.size() << " rays\n";
        bounce(accel, sun, rays, paths, picture);
    }
    write_picture(folder / "02_ray_tracer.png", width, height, picture);
    // [/loop]

    // From a point above the floor towards the sun: the middle of the red sphere is in the way.
    const Ray down{
        .origin = vec3(-2.625f, 0.125f, -0.4375f), .t_min = 0, .direction = vec3(0.6f, 1, 0.5f), .t_max = INFINITY};
    std::cout << "the shadow is dark: " << (accel.any_hits({&down, 1}).front().hit ? "yes" : "no") << '\n';
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
