// SPDX-License-Identifier: MIT
// Random scenes and rays on a grid of numbers, so that moves, turns and scales of them are exact.
#pragma once

#include <random>

#include "report/conformance/query.h"
#include "report/conformance/scene_input.h"

namespace twinray::conformance {

// A random generator: one seed gives the same numbers on every platform.
class Draws {
  public:
    explicit Draws(std::uint64_t seed) : engine_(seed) {}

    uint below(uint count) { return static_cast<uint>(engine_() % count); }
    bool chance(double share) { return unit() < share; }
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    // Returns a multiple of 2^-10 in [-extent, extent].
    float coordinate(float extent);
    vec3 point(float extent);
    // Returns multiples of 2^-8; the length is between 1/2 and 2.
    vec3 direction();

  private:
    std::mt19937_64 engine_;
};

constexpr uint usual_triangle_count = 24;
// Makes random triangles about the origin, within [-1.5, 1.5]. They are too large for rounding to turn them into edges.
GeometryInput random_triangles(Draws& draws, uint count);
// Makes boxes one behind the other along z, from z = 2 i to 2 i + 1; x and y reach from -1 to 1.
GeometryInput layered_boxes(uint count);
// Makes the same as triangles at z = 2 i, larger than the boxes.
GeometryInput layered_triangles(uint count);
SceneInput scene_of(GeometryInput geometry);
SceneInput scene_of(std::vector<GeometryInput> geometries);
// Makes two instances, because no bottom level may hold both.
SceneInput scene_of_both(std::vector<GeometryInput> triangles, std::vector<GeometryInput> boxes);

// Makes rays from afar through the middle of the scene; about every second one hits something.
std::vector<Shot> random_shots(Draws& draws, std::size_t count, float extent = 1);
// Makes rays along z through x, y in (-0.75, 0.75), from z = -1, for layered scenes.
std::vector<Shot> layer_shots(Draws& draws, std::size_t count);
// Makes the same rays, which hit each box in its middle.
std::vector<Shot> box_shots(Draws& draws, std::size_t count);
Shot shot_of(const Ray& ray);
// Returns a random transform that rotates, scales, shears and mirrors; its inverse loses little.
Transform random_instance_transform(Draws& draws);

}  // namespace twinray::conformance
