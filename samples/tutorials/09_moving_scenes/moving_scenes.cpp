// SPDX-License-Identifier: MIT
// Waves and floating balls, moved by kernels: moving_scenes FOLDER
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "scene.h"

// [expected]
// Traces from above onto the middle of each ball: there the hit must be the top of the ball.
double largest_error(AbstractAccel& accel, float time) {
    std::vector<Ray> rays;
    for (uint ball = 0; ball < ball_count; ++ball) {
        const vec2 place = place_of_ball(ball);
        rays.push_back({.origin = {place.x, 2, place.y}, .t_min = 0, .direction = {0, -1, 0}, .t_max = 4});
    }
    const std::vector<Hit> hits = accel.closest_hits(rays);
    double largest = 0;
    for (uint ball = 0; ball < ball_count; ++ball) {
        const double top = height_of(place_of_ball(ball), time) + BALL_RADIUS;
        if (hits[ball].custom_index != 1) throw Error("ball " + std::to_string(ball) + " is not where it should be");
        largest = std::max(largest, std::abs(2 - hits[ball].t - top));
    }
    return largest;
}

// [rebuilt]
// Compares hits after a refit with hits of a new accelerator with the same water.
std::size_t differing_hits(AbstractAccel& refitted, const std::vector<vec3>& vertices) {
    Mesh water = make_water();
    water.positions = vertices;
    SwTlas rebuilt(refitted.context());
    rebuilt.push(water);
    std::vector<Ray> rays;
    for (int i = 0; i < 10'000; ++i) {
        const float x = 0.04f * float(i % 100) - 1.98f, z = 0.04f * float(i / 100) - 1.98f;
        rays.push_back({.origin = {x, 2, z}, .t_min = 0, .direction = {0.1f, -1, 0.05f}, .t_max = 4});
    }
    const std::vector<Hit> a = refitted.closest_hits(rays), b = rebuilt.closest_hits(rays);
    std::size_t differing = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (a[i].custom_index == 0 && (a[i].t != b[i].t || a[i].primitive_index != b[i].primitive_index)) ++differing;
    return differing;
}
// [/rebuilt]

int main(int argc, char** argv) try {
    if (argc != 2) throw Error("usage: moving_scenes FOLDER");
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    const uint width = 320, height = 280, gap = 4, across = 3 * width + 2 * gap;
    std::vector<Rgb> strip(across * height, Rgb{255, 255, 255});
    // [main]
    Context context;
    SwTlas accel(context, {.keeps_surfaces = true});
    Pond pond(accel);
    const std::uint64_t revision = accel.revision();
    for (uint frame = 0; frame < 3; ++frame) {
        const float time = 0.8f * static_cast<float>(frame);
        Commands commands(context, "frame");
        pond.move(commands, time);
        commands.submit();
        const std::vector<Rgb> picture = pond.picture(width, height);
        const double error = largest_error(accel, time);
        const std::size_t differing = differing_hits(accel, pond.vertices());
        std::cout << "frame " << frame << ": balls are off by " << error << " at most; " << differing
                  << " hits on water differ from those of a new tree\n";
        // [/main]
        // Kernels and host each have a sine of their own; Vulkan's may be off by 2^-11.
        if (error > 1e-3 || differing > 0) throw Error("the accelerator does not show what the kernels wrote");
        for (uint y = 0; y < height; ++y)
            std::copy_n(&picture[y * width], width, &strip[y * across + frame * (width + gap)]);
    }
    if (accel.revision() != revision) throw Error("views became stale");
    write_png(folder / "09_moving_scenes.png", across, height, strip);
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
