// SPDX-License-Identifier: MIT
#include "engine/scene/local_origin.h"

#include <twinray/scene.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace twinray {
namespace {

double largest_entry(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

// Returns the largest power of ten, or below 1 of two, that is not larger: its multiples are float64.
double round_step(double extent) {
    return extent < 1 ? std::exp2(std::floor(std::log2(extent))) : std::pow(10.0, std::floor(std::log10(extent)));
}

double rounded(double value, double step) { return std::round(value / step) * step + 0.0; }  // not -0

}  // namespace

void Bounds64::include(const dvec3& point) {
    if (is_finite(point)) lo = min(lo, point), hi = max(hi, point);
}

double Bounds64::extent() const { return is_empty() ? 0 : largest_entry(hi - lo); }

double Bounds64::reach() const { return is_empty() ? 0 : largest_entry(max(abs(lo), abs(hi))); }

dvec3 choose_local_origin(const Bounds64& bounds) {
    const double reach = bounds.reach();
    constexpr double smallest = std::numeric_limits<float>::min();  // below it, float32 has hardly any steps
    if (reach < smallest || !is_far(reach, bounds.extent())) return dvec3(0);
    // A point may be the rounded rest of something smaller than a step of float32.
    const double step = round_step(bounds.extent() > 0 ? bounds.extent() : reach * 0x1p-23);
    const dvec3 middle = bounds.lo * 0.5 + bounds.hi * 0.5;
    return {rounded(middle.x, step), rounded(middle.y, step), rounded(middle.z, step)};
}

std::vector<vec3> local_positions(std::span<const dvec3> positions, const dvec3& origin) {
    std::vector<vec3> local;
    local.reserve(positions.size());
    for (const dvec3& position : positions) local.emplace_back(position - origin);
    return local;
}

std::string origin_text(const dvec3& origin) {
    std::string words;
    for (int axis = 0; axis < 3; ++axis) {
        std::array<char, 400> digits{};  // the longest is that of the smallest float64
        const auto end = std::to_chars(digits.begin(), digits.end(), origin[axis], std::chars_format::fixed).ptr;
        if (axis > 0) words += ' ';
        words.append(digits.begin(), end);
    }
    return words;
}

}  // namespace twinray
