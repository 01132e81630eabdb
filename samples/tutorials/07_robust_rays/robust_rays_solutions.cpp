// SPDX-License-Identifier: MIT
// Solutions of the exercises.
#include <iostream>
#include <random>

#include <twinray/scene.h>
#include <twinray/tlas.h>
#include <twinray/validation.h>

#include "body.h"

// [exercise1]
// Rays in random directions, not aimed at anything. How many get out at level fast?
std::size_t random_rays_out(Context& context, const Mesh& body) {
    SwTlas accel(context);
    accel.push(body);
    std::mt19937 random(7);
    const auto coordinate = [&] { return static_cast<float>(random() >> 8) / 8388608.0f - 1; };
    std::vector<Ray> rays;
    while (rays.size() < 200'000) {
        const float x = coordinate(), y = coordinate(), z = coordinate();
        if (x * x + y * y + z * z < 1)
            rays.push_back({.origin = vec3(0), .t_min = 0, .direction = {x, y, z}, .t_max = INFINITY});
    }
    std::size_t out = 0;
    for (const Hit& hit : accel.closest_hits(rays, {.level = Level::fast})) out += hit.hit == 0;
    return out;
}

// [exercise2]
// The body a thousand lengths away: coordinates have fewer digits left for its shape.
LeakCounts far_away(Context& context, Mesh body) {
    for (vec3& p : body.positions) p += vec3(1000, -500, 250);
    SwTlas accel(context);
    LeakCounts counts;
    LeakTest(accel, body, Level::watertight, 3).trace(100'000, counts);
    return counts;
}

// [exercise3]
// Tests the driver's own structures with the same rays.
LeakCounts of_driver(Context& context, const Mesh& body) {
    HwTlas accel(context);
    LeakCounts counts;
    LeakTest(accel, body, Level::watertight, 1).trace(100'000, counts);
    return counts;
}
// [/exercise3]

int main() try {
    Context context;
    const Mesh body = make_body();
    std::cout << "1: " << random_rays_out(context, body) << " of 200000 random rays got out at level fast\n";
    const LeakCounts away = far_away(context, body);
    std::cout << "2: far away, " << away.faults() << " faults of " << away.rays << " rays\n";
    if (away.rays != 100'000 || away.faults() > 0) throw Error("a ray leaked far away");
    if (!context.properties().ray_query) return 0;
    const LeakCounts driver = of_driver(context, body);
    std::cout << "3: by the driver, " << driver.leaks << " leaks and " << driver.double_hits << " double hits of "
              << driver.rays << " rays\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
