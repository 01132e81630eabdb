// SPDX-License-Identifier: MIT
// Factors of glTF materials, kept within what glTF allows: outside of it, surfaces would emit by reflecting.
#pragma once

#include <algorithm>
#include <vector>

#include <twinray/geometry.h>

namespace twinray {

inline float clamped_factor(double factor, double lo, double hi) {
    return static_cast<float>(factor >= lo ? std::min(factor, hi) : lo);  // NaN becomes lo
}

inline float unit_factor(double factor) { return clamped_factor(factor, 0, 1); }

template <int N>
Vec<N, float> color_factor(const std::vector<double>& factors, Vec<N, float> fallback, double most = 1) {
    if (factors.size() != N) return fallback;
    Vec<N, float> color;
    for (int i = 0; i < N; ++i) color[i] = clamped_factor(factors[std::size_t(i)], 0, most);
    return color;
}

}  // namespace twinray
