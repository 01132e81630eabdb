// SPDX-License-Identifier: MIT
// The parts from which cases make their scenes and rays.
#pragma once

#include <random>

#include "report/suite/tracing.h"

namespace twinray::suite {

inline constexpr float inf = std::numeric_limits<float>::infinity();
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A random generator: one seed gives the same numbers on every platform.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(static_cast<std::uint32_t>(seed)) {}
    float between(float low, float high) { return low + (high - low) * static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    vec3 in_box(float extent);
    vec3 direction();      // uniform on the unit sphere
    Transform rotation();  // uniform
    vec2 in_triangle();    // (u, v), uniform
    uint below(std::size_t count) { return static_cast<uint>(engine_()) % static_cast<uint>(count); }
    // Returns positive weights of three vertices, which sum to 1 and are at least `least`.
    dvec3 weights(double least);

  private:
    std::mt19937 engine_;
};

// Both leave the mesh without normals and texture coordinates.
void add_triangle(Mesh& mesh, vec3 a, vec3 b, vec3 c);
void append(Mesh& mesh, const Mesh& part);
Mesh scaled(Mesh mesh, float factor);
Mesh moved(Mesh mesh, vec3 offset);
// Makes an instance of the mesh for each transform.
Scene instances_of(const Mesh& mesh, const std::vector<Transform>& transforms = {Transform{}});
// Turns axes: x becomes y, y becomes z, z becomes x, `times` times.
vec3 turned(vec3 v, int times);
// Moves the origins only; t changes by the factor.
std::vector<Ray> scaled(std::vector<Ray> rays, float factor);

// Axes scaled within 10^most and 10^-most, then turned. The ray follows the axis that is scaled least. In object space
// it begins 3 before the middle and covers 1 per unit of t, so that rounding moves it by little there.
struct ScaledPlace {
    Transform transform;
    Ray ray;
};
ScaledPlace scaled_place(Random& random, float most);

// Returns a ray from an origin, which is rounded first, to the target, which it passes within float32 rounding.
// |direction| = 1.
Ray ray_to(const dvec3& target, const dvec3& origin);
// Spreads `random` of them over the bounds, and aims `aimed` at vertices and as many at edges.
std::vector<Ray> random_and_aimed(const ReferenceScene& reference, const Bounds& bounds, std::size_t random,
                                  std::size_t aimed, std::uint64_t seed);
// Spreads half of them over the bounds, and aims a quarter each at vertices and at edges.
std::vector<Ray> mixed_rays(const World& world, const Bounds& bounds, std::size_t count, std::uint64_t seed);

}  // namespace twinray::suite
