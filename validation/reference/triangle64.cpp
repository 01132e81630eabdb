// SPDX-License-Identifier: MIT
#include "validation/reference/triangle64.h"

#include <algorithm>
#include <cmath>

namespace twinray {
namespace {

// Returns the products whose sum is the triangle's doubled area, seen along one axis. A product of two float32 is exact
// in float64.
std::array<double, 6> area_products(const std::array<vec3, 3>& triangle, int axis) {
    const int x = (axis + 1) % 3;
    const int y = (axis + 2) % 3;
    std::array<double, 6> products{};
    for (std::size_t i = 0; i < 3; ++i) {
        const vec3& a = triangle[i];
        const vec3& b = triangle[(i + 1) % 3];
        products[2 * i] = double{a[x]} * double{b[y]};
        products[2 * i + 1] = -(double{a[y]} * double{b[x]});
    }
    return products;
}

// Exact: Shewchuk's grow-expansion ("Adaptive Precision Floating-Point Arithmetic", 1997, theorem 10) keeps the
// sum as non-overlapping parts, which add up to zero only if all of them are zero.
bool is_sum_zero(const std::array<double, 6>& terms) {
    std::array<double, 6> parts{};
    for (std::size_t n = 0; n < terms.size(); ++n) {
        double sum = terms[n];
        for (std::size_t i = 0; i < n; ++i) {
            const double a = sum;
            sum = a + parts[i];
            const double b_virtual = sum - a;
            parts[i] = (a - (sum - b_virtual)) + (parts[i] - b_virtual);
        }
        parts[n] = sum;
    }
    return std::all_of(parts.begin(), parts.end(), [](double part) { return part == 0; });
}

int longest_axis(const dvec3& v) {
    const dvec3 a = abs(v);
    if (a.x >= a.y && a.x >= a.z) return 0;
    return a.y >= a.z ? 1 : 2;
}

}  // namespace

bool has_area(const std::array<vec3, 3>& triangle) {
    for (const vec3& vertex : triangle)
        if (!std::isfinite(vertex.x) || !std::isfinite(vertex.y) || !std::isfinite(vertex.z)) return false;
    for (int axis = 0; axis < 3; ++axis)
        if (!is_sum_zero(area_products(triangle, axis))) return true;
    return false;
}

ShearedRay::ShearedRay(const dvec3& origin, const dvec3& direction) : origin_(origin) {
    const int z = longest_axis(direction);
    axes_ = {(z + 1) % 3, (z + 2) % 3, z};
    shear_ = {direction[axes_.x] / direction[z], direction[axes_.y] / direction[z], 1.0 / direction[z]};
}

dvec3 ShearedRay::project(const dvec3& point) const {
    const dvec3 p = point - origin_;
    const double z = p[axes_.z];
    return {p[axes_.x] - shear_.x * z, p[axes_.y] - shear_.y * z, z};
}

std::optional<TriangleHit64> ShearedRay::intersect(const Triangle64& triangle) const {
    const dvec3 a = project(triangle[0]);
    const dvec3 b = project(triangle[1]);
    const dvec3 c = project(triangle[2]);
    const double weight_a = c.x * b.y - c.y * b.x;
    const double weight_b = a.x * c.y - a.y * c.x;
    const double weight_c = b.x * a.y - b.y * a.x;
    const bool any_negative = weight_a < 0 || weight_b < 0 || weight_c < 0;
    const bool any_positive = weight_a > 0 || weight_b > 0 || weight_c > 0;
    if (any_negative == any_positive) return std::nullopt;  // outside, or all zero: edge-on
    const double sum = weight_a + weight_b + weight_c;
    const double v = weight_c / sum;
    const double u = weight_b / sum;
    // Weights of one sign: t lies between the vertices' depths however thin the triangle is.
    const double t = (weight_a / sum * a.z + u * b.z + v * c.z) * shear_.z;
    // The sum is minus the doubled area of the image, whose normal's depth is that of the triangle's: shearing keeps
    // it.
    return TriangleHit64{t, u, v, (sum < 0) == (shear_.z > 0)};
}

}  // namespace twinray
