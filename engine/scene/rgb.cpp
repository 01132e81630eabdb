// SPDX-License-Identifier: MIT
// sRGB and linear light (IEC 61966-2-1).
#include <twinray/scene.h>

#include <algorithm>
#include <cmath>
#include <compare>

#include "twinray/glsl/cpp.h"

namespace twinray {

float linear_of_srgb(float encoded) {
    const float c = std::clamp(encoded, 0.0f, 1.0f);
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}
float srgb_of_linear(float linear) {
    const float c = linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
    return std::clamp(c, 0.0f, 1.0f);
}

vec3 linear_of(Rgb color) {
    return {linear_of_srgb(static_cast<float>(color.r) / 255), linear_of_srgb(static_cast<float>(color.g) / 255),
            linear_of_srgb(static_cast<float>(color.b) / 255)};
}

Rgb rgb_of_linear(vec3 linear) {
    const auto byte = [](float value) { return static_cast<std::uint8_t>(std::lround(srgb_of_linear(value) * 255)); };
    return {byte(linear.x), byte(linear.y), byte(linear.z)};
}

}  // namespace twinray
