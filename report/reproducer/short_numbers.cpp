// SPDX-License-Identifier: MIT
#include "report/reproducer/short_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace twinray::reproducer {
namespace {

constexpr int significant_bits = std::numeric_limits<float>::digits;

// The nearest number of so many significant bits.
float rounded_to(float value, int bits) {
    int exponent = 0;
    const float fraction = std::frexp(value, &exponent);
    return std::ldexp(std::nearbyint(std::ldexp(fraction, bits)), exponent - bits);
}

int bits_of(float value) {
    for (int bits = 1; bits < significant_bits; ++bits)
        if (rounded_to(value, bits) == value) return bits;
    return significant_bits;
}

}  // namespace

int length_of(float value) {
    if (value == 0 || std::isinf(value)) return 0;
    if (std::isnan(value)) return std::numeric_limits<int>::max();
    int exponent = 0;
    static_cast<void>(std::frexp(value, &exponent));
    constexpr int near_one = 8;  // exponents up to it cost nothing: 1/256 to 256
    return 2 * bits_of(value) + std::max(std::abs(exponent) - near_one, 0) + (value < 0 ? 1 : 0);
}

std::vector<float> shorter_numbers(float value) {
    if (!std::isfinite(value)) return {};
    std::vector<float> candidates = {0};
    for (int bits = 1; bits < significant_bits; ++bits) candidates.push_back(rounded_to(value, bits));
    for (const float step : {1.0f, 0.5f, 0.25f, 0.125f, 0.0625f})
        if (std::abs(value) < 0x1p20f) candidates.push_back(step * std::nearbyint(value / step));
    std::erase_if(candidates, [&](float c) { return !std::isfinite(c) || length_of(c) >= length_of(value); });
    std::ranges::stable_sort(candidates, {}, length_of);
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    return candidates;
}

}  // namespace twinray::reproducer
