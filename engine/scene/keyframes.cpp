// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "engine/scene/rig.h"

namespace twinray {
namespace {

using Value = std::vector<double>;

enum Part : std::size_t { in_tangent = 0, value = 1, out_tangent = 2 };  // of a time of cubic_spline

Value stored(const Keyframes& keyframes, std::size_t key, Part part = value) {
    const bool is_cubic = keyframes.interpolation == Interpolation::cubic_spline;
    const std::size_t first = (is_cubic ? 3 * key + part : key) * keyframes.width;
    const auto begin = keyframes.values.begin() + static_cast<std::ptrdiff_t>(first);
    return {begin, begin + keyframes.width};
}

double length_of(const Value& v) {
    double sum = 0;
    for (const double x : v) sum += x * x;
    return std::sqrt(sum);
}

Value weighted(const Value& a, double weight_a, const Value& b, double weight_b) {
    Value sum(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) sum[i] = weight_a * a[i] + weight_b * b[i];
    return sum;
}

// Returns `fallback` if the value has no direction.
Value normalized(Value v, const Value& fallback) {
    const double length = length_of(v);
    if (!(length > 0)) return fallback;
    for (double& x : v) x /= length;
    return v;
}

// Follows the shorter great circle. The angle comes from the lengths of difference and sum: small ones are exact.
Value slerp(const Value& a, Value b, double t) {
    double cosine = 0;
    for (std::size_t i = 0; i < a.size(); ++i) cosine += a[i] * b[i];
    if (cosine < 0) b = weighted(b, -1, b, 0);
    const double angle = 2 * std::atan2(length_of(weighted(a, 1, b, -1)), length_of(weighted(a, 1, b, 1)));
    const double sine = std::sin(angle);
    if (!(sine > 0)) return a;
    return weighted(a, std::sin((1 - t) * angle) / sine, b, std::sin(t * angle) / sine);
}

// Interpolates as in glTF 2.0, appendix C.5. Tangents are per second.
Value hermite(const Keyframes& keyframes, std::size_t key, double t, double duration) {
    const double t2 = t * t, t3 = t2 * t;
    const Value points =
        weighted(stored(keyframes, key), 2 * t3 - 3 * t2 + 1, stored(keyframes, key + 1), 3 * t2 - 2 * t3);
    const Value tangents = weighted(stored(keyframes, key, out_tangent), duration * (t3 - 2 * t2 + t),
                                    stored(keyframes, key + 1, in_tangent), duration * (t3 - t2));
    return weighted(points, 1, tangents, 1);
}

Value between(const Keyframes& keyframes, std::size_t key, double seconds) {
    const double begin = keyframes.times[key], duration = keyframes.times[key + 1] - begin;
    const double t = (seconds - begin) / duration;
    const Value a = stored(keyframes, key);
    switch (keyframes.interpolation) {
        case Interpolation::step: break;
        case Interpolation::cubic_spline: return hermite(keyframes, key, t, duration);
        case Interpolation::linear: {
            const Value b = stored(keyframes, key + 1);
            return keyframes.is_rotation ? slerp(normalized(a, a), normalized(b, b), t) : weighted(a, 1 - t, b, t);
        }
    }
    return a;
}

}  // namespace

std::vector<double> value_at(const Keyframes& keyframes, double seconds) {
    const auto& times = keyframes.times;
    const auto next =
        std::ranges::upper_bound(times, seconds, {}, [](float time) { return static_cast<double>(time); });
    const std::size_t key = next == times.begin() ? 0 : static_cast<std::size_t>(next - times.begin()) - 1;
    const bool is_outside = next == times.begin() || next == times.end();
    Value result = is_outside ? stored(keyframes, key) : between(keyframes, key, seconds);
    return keyframes.is_rotation ? normalized(std::move(result), stored(keyframes, key)) : result;
}

}  // namespace twinray
