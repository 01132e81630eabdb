// SPDX-License-Identifier: MIT
#include "validation/exact/triangle.h"

#include <algorithm>

namespace twinray::exact {
namespace {

std::array<Vector, 3> from_origin(const Line& line, const Triangle64& triangle) {
    return {vector_of(triangle[0]) - line.origin, vector_of(triangle[1]) - line.origin,
            vector_of(triangle[2]) - line.origin};
}

std::array<Rational, 3> edge_values(const Vector& direction, const std::array<Vector, 3>& vertices) {
    const auto& [a, b, c] = vertices;
    return {dot(direction, cross(b, c)), dot(direction, cross(c, a)), dot(direction, cross(a, b))};
}

}  // namespace

double rounded(const Rational& value) {
    const double toward_zero = value.get_d();  // mpq_get_d truncates
    const double away = std::nextafter(toward_zero, value < 0 ? -INFINITY : INFINITY);
    if (!std::isfinite(away)) return toward_zero;
    const Rational middle = (Rational(toward_zero) + Rational(away)) / 2;
    if (value == middle) return std::bit_cast<std::uint64_t>(toward_zero) % 2 == 0 ? toward_zero : away;
    return abs(value) < abs(middle) ? toward_zero : away;
}

std::array<Rational, 3> edge_values(const Line& line, const Triangle64& triangle) {
    return edge_values(line.direction, from_origin(line, triangle));
}

std::optional<Crossing> crossing(const Line& line, const Triangle64& triangle) {
    const std::array<Vector, 3> vertices = from_origin(line, triangle);
    const std::array<Rational, 3> values = edge_values(line.direction, vertices);
    const auto count = [&](int sign) {
        return std::count_if(values.begin(), values.end(), [&](const Rational& value) { return sgn(value) == sign; });
    };
    if (count(-1) > 0 && count(1) > 0) return std::nullopt;
    const Rational sum = values[0] + values[1] + values[2];
    if (sum == 0) return std::nullopt;
    const Vector normal = cross(vertices[1] - vertices[0], vertices[2] - vertices[0]);
    const Rational along = dot(normal, line.direction);
    return Crossing{dot(normal, vertices[0]) / along, values[1] / sum, values[2] / sum,
                    static_cast<Incidence>(count(0)), along > 0};
}

}  // namespace twinray::exact
