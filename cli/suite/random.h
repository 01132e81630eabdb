// SPDX-License-Identifier: MIT
// Random numbers, rotations and points for cases; the same seed gives the same everywhere.
#pragma once

#include <cmath>
#include <random>

#include "engine/core/transform.h"

namespace twinray::suite {

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(static_cast<std::uint32_t>(seed)) {}
    float between(float low, float high) { return low + (high - low) * static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    vec3 in_box(float extent) {
        const float x = between(-extent, extent), y = between(-extent, extent);
        return {x, y, between(-extent, extent)};
    }
    // Of a random unit quaternion (rejection, as uniform on the sphere of dimension 4), evaluated in float64.
    Transform rotation() {
        for (;;) {
            const double w = between(-1, 1), x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
            const double square = w * w + x * x + y * y + z * z;
            if (square > 1 || square < 0.01) continue;
            const double s = 2 / square;
            Transform result;
            result.rows[0] = vec4(1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y), 0);
            result.rows[1] = vec4(s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x), 0);
            result.rows[2] = vec4(s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y), 0);
            return result;
        }
    }

    // Uniform on the sphere.
    vec3 direction() {
        const float z = between(-1, 1), angle = between(0, 6.2831853f), radius = std::sqrt(1 - z * z);
        return {radius * std::cos(angle), radius * std::sin(angle), z};
    }
    // (u, v), uniform in the triangle.
    vec2 in_triangle() {
        const float u = between(0, 1), v = between(0, 1);
        return u + v <= 1 ? vec2(u, v) : vec2(1 - u, 1 - v);
    }
    uint below(std::size_t count) { return static_cast<uint>(engine_()) % static_cast<uint>(count); }

  private:
    std::mt19937 engine_;
};

}  // namespace twinray::suite
