// Rays for verification and measurement: a camera's, spread over a scene, or aimed where intersection tests break; and
// the random numbers that they are made of.
#pragma once

#include "validation/reference/reference_scene.h"

namespace twinray {

// A stream of random numbers per (seed, item), the same on every platform: the n-th is SplitMix64's finaliser (Steele,
// Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators") of a counter, so that any item can be made
// alone and in any order.
class Draws {
  public:
    Draws(std::uint64_t seed, std::uint64_t item) : state_(mixed(mixed(seed) + item)) {}

    std::uint64_t bits() { return mixed(state_ += 0x9E3779B97F4A7C15u); }
    double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  // [0, 1)
    double between(double low, double high) { return low + (high - low) * unit(); }
    // Returns a number below n: the high word of the 32 x 32 bit product, n < 2^32.
    uint below(std::size_t n) { return static_cast<uint>((bits() >> 32) * n >> 32); }

    // Returns a direction uniform on the unit sphere, by rejection, with correctly rounded operations only.
    dvec3 direction() {
        for (;;) {
            const double z = between(-1, 1), y = between(-1, 1), x = between(-1, 1);
            const double square = x * x + y * y + z * z;
            if (square <= 1 && square > 0x1p-20) return dvec3(x, y, z) / std::sqrt(square);
        }
    }

  private:
    static std::uint64_t mixed(std::uint64_t x) {
        x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
        x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
        return x ^ (x >> 31);
    }

    std::uint64_t state_;
};

// All generators: ray i depends only on (seed, i) and the scene, never on the platform or on `count`; origins and
// directions are finite, directions have length 1 up to rounding, t_min = 0 and t_max = infinity.

// Even rays start in the box grown by a tenth of its diagonal, odd ones in the box grown by one diagonal;
// directions are uniform on the sphere. An empty box counts as the unit cube around 0.
std::vector<Ray> random_rays(const Bounds& bounds, std::size_t count, std::uint64_t seed);

// Each ray is aimed at a vertex of a random active triangle of a random instance, transformed in float64, from an
// origin 0.05 to 2 scene diagonals away, inside or outside the scene. origin is rounded to float32 first and
// direction = (target - origin) / length last, so the ray passes its target within float32 rounding.
// Without an active triangle these are random_rays of an empty box.
std::vector<Ray> vertex_aimed_rays(const ReferenceScene& scene, std::size_t count, std::uint64_t seed);

// Does the same, aimed at a point (1-w) a + w b of an edge, w uniform in [0, 1).
std::vector<Ray> edge_aimed_rays(const ReferenceScene& scene, std::size_t count, std::uint64_t seed);

// Returns pinhole rays over the scene from a corner above, in tiles of 8 x 8 pixels as a renderer would; `width` pixels
// per side, a multiple of 8.
std::vector<Ray> primary_rays(const Bounds& bounds, uint width);

}  // namespace twinray
