// SPDX-License-Identifier: MIT
// Random numbers of rays.
#pragma once

#include <cmath>
#include <cstdint>

#include "twinray/glsl/cpp.h"

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

}  // namespace twinray
