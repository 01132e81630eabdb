// SPDX-License-Identifier: MIT
// Solutions of the exercises.
#include <cmath>
#include <iostream>
#include <numbers>

#include <twinray/validation.h>

#include "drilled.trace_program.h"
#include "ways.h"

// [exercise1]
// Returns the part of light that passes a wall of drilled triangles, from rays straight at it.
double light_through(const Way& way) {
    const std::unique_ptr<AbstractAccel> accel = way.make_accel();
    accel->push(make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), {}, {.non_opaque = true});
    accel->sync();
    const std::unique_ptr<TraceProgram> program = accel->make_program(drilled);
    constexpr uint side = 500;
    std::vector<Ray> rays;
    for (uint i = 0; i < side * side; ++i)
        rays.push_back({.origin = {(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side, 1},
                        .t_min = 0,
                        .direction = {0, 0, -1},
                        .t_max = INFINITY});
    double passed = 0;
    for (const Hit& hit : accel->any_hits(rays, {.program = program.get()})) passed += hit.hit == 0;
    return passed / (side * side);
}

// [exercise2]
// The remaining differences from software if float64 recomputes t.
struct Left {
    std::size_t other_t = 0;  // on the same triangle
    std::uint64_t lost = 0;   // by the driver
};
Left left_at(Level level, const Way& software, const Way& hardware, const Mesh& ball, const Reference& reference) {
    const std::vector<Ray> rays = vertex_aimed_rays(reference, 100'000, 1);
    std::vector<std::vector<Hit>> hits;
    for (const Way* way : {&software, &hardware}) {
        const std::unique_ptr<AbstractAccel> accel = way->make_accel({.level = level});
        accel->push(ball);
        hits.push_back(accel->closest_hits(rays, {.level = level}));
    }
    Left left;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit &ours = hits[0][i], &theirs = hits[1][i];
        left.other_t += ours.hit && theirs.hit && ours.primitive_index == theirs.primitive_index && ours.t != theirs.t;
    }
    left.lost = count(reference.classify(rays, hits[1], TracedBy::hardware))[HitClass::hw_leak];
    return left;
}

// [exercise3]
// In a closed room every ray hits. Those that the driver loses are traced again by software.
std::vector<Hit> hits_in_room(AbstractAccel& hardware, AbstractAccel& software, std::span<const Ray> rays,
                              std::size_t& again) {
    std::vector<Hit> hits = hardware.closest_hits(rays);
    std::vector<Ray> lost;
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].hit) continue;
        lost.push_back(rays[i]);
        at.push_back(i);
    }
    const std::vector<Hit> found = software.closest_hits(lost);
    for (std::size_t i = 0; i < lost.size(); ++i) hits[at[i]] = found[i];
    again = lost.size();
    return hits;
}
// [/exercise3]

std::vector<Ray> rays_from_inside(const Mesh& ball) {
    std::vector<Ray> rays;
    for (const vec3 origin : {vec3(0.1f, 0.2f, 0.3f), vec3(-0.3f, 0.1f, 0.2f), vec3(0.25f, -0.2f, 0.1f)})
        for (const vec3& p : ball.positions)
            rays.push_back({.origin = origin,
                            .t_min = 0,
                            .direction = {p.x - origin.x, p.y - origin.y, p.z - origin.z},
                            .t_max = INFINITY});
    return rays;
}

int main() try {
    const std::vector<Way> ways = ways_of_device();
    const Mesh ball = make_icosphere(5);
    const MeshView view(ball);
    const Reference reference({&view, 1}, std::array{ReferenceInstance{}});
    const std::vector<Ray> inside = rays_from_inside(ball);
    const double by_formula = 2 * std::numbers::pi * 0.09 / std::sqrt(3.0);
    for (const Way& way : ways) {
        const double passed = light_through(way);
        std::cout << "1: " << passed << " of the light passes, says " << way.name << "; the formula " << by_formula
                  << '\n';
        if (std::abs(passed - by_formula) > 0.002) throw Error("the holes have the wrong size");
    }
    for (std::size_t i = 1; i < ways.size(); ++i) {
        const bool has_float64 = ways[i].context->properties().shader_float64;
        for (const Level level : {Level::watertight, Level::refined}) {
            if (level == Level::refined && !has_float64) continue;
            const Left left = left_at(level, ways[0], ways[i], ball, reference);
            std::cout << "2: " << ways[i].name << " at level " << name_of(level) << ": " << left.other_t << " other t, "
                      << left.lost << " lost\n";
            if (level == Level::refined && left.other_t > 0) throw Error("float64 did not agree with itself");
        }
        std::size_t again = 0, lost = 0;
        const std::unique_ptr<AbstractAccel> hardware = ways[i].make_accel(), software = ways[0].make_accel();
        for (AbstractAccel* accel : {hardware.get(), software.get()}) accel->push(ball);
        for (const Hit& hit : hits_in_room(*hardware, *software, inside, again)) lost += hit.hit == 0;
        std::cout << "3: " << ways[i].name << " lost " << again << " of " << inside.size() << " rays, " << lost
                  << " are left\n";
        if (lost > 0) throw Error("a ray got out of the room");
    }
    std::cout << "the solutions hold\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
