// SPDX-License-Identifier: MIT
#include "engine/collide/exact_sign.h"

#include <cmath>
#include <sstream>

#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/exact_double.h"
#include "twinray/glsl/cpp_end.h"

// Returns the rounding error of the sum s = fl(a + b) (Knuth's TwoSum).
double sum_error(double a, double b, double s) {
    const double b_virtual = s - a;
    const double a_virtual = s - b_virtual;
    return (a - a_virtual) + (b - b_virtual);
}

// A difference of doubles without rounding.
struct Difference {
    double high, low;

    Difference(double a, double b) : high(a - b) {
        const double b_virtual = a - high;
        const double a_virtual = high + b_virtual;
        low = (a - a_virtual) + (b_virtual - b);
    }
};

struct Differences {
    Difference x, y, z;

    Differences(const dvec3& a, const dvec3& b) : x(a.x, b.x), y(a.y, b.y), z(a.z, b.z) {}
};

void add_product(Expansion& sum, const Difference& a, const Difference& b, const Difference& c, double sign) {
    for (const double x : {a.high, a.low})
        for (const double y : {b.high, b.low})
            for (const double z : {c.high, c.low})
                if (x != 0 && y != 0 && z != 0) sum.add_product(sign * x, y, z);
}

int exact_area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis) {
    const int u = static_cast<int>(axis + 1) % 3, v = static_cast<int>(axis + 2) % 3;
    const Difference one(1, 0);
    Expansion area;
    add_product(area, Difference(a[u], c[u]), Difference(b[v], c[v]), one, 1);
    add_product(area, Difference(a[v], c[v]), Difference(b[u], c[u]), one, -1);
    return area.sign();
}

}  // namespace

void Expansion::add(double term) {
    double carry = term;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
        const double sum = carry + terms_[i];
        const double error = sum_error(carry, terms_[i], sum);
        if (error != 0) terms_[kept++] = error;
        carry = sum;
    }
    if (carry != 0) terms_[kept++] = carry;
    size_ = kept;
}

void Expansion::add_product(double x, double y, double z) {
    const double xy = x * y, xy_error = product_error_double(x, y, xy);
    for (const double part : {xy_error, xy}) {
        if (part == 0) continue;
        const double product = part * z;
        add(product_error_double(part, z, product));
        add(product);
    }
}

double Expansion::value() const {
    double sum = 0;
    for (std::size_t i = 0; i < size_; ++i) sum += terms_[i];
    return sum;
}

Expansion volume_of(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    const Differences ad(a, d), bd(b, d), cd(c, d);
    Expansion volume;
    add_product(volume, ad.z, bd.x, cd.y, 1);
    add_product(volume, ad.z, cd.x, bd.y, -1);
    add_product(volume, bd.z, cd.x, ad.y, 1);
    add_product(volume, bd.z, ad.x, cd.y, -1);
    add_product(volume, cd.z, ad.x, bd.y, 1);
    add_product(volume, cd.z, bd.x, ad.y, -1);
    return volume;
}

int volume_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    const int sign = filtered_volume_sign(a, b, c, d);
    return sign == UNKNOWN_SIGN ? volume_of(a, b, c, d).sign() : sign;
}

int area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis) {
    const int sign = filtered_area_sign(a, b, c, axis);
    return sign == UNKNOWN_SIGN ? exact_area_sign(a, b, c, axis) : sign;
}

std::string sign_fault_of(const dvec3& point) {
    for (int axis = 0; axis < 3; ++axis) {
        const double size = std::abs(point[axis]);
        if (size == 0 || (size >= 0x1p-245 && size <= 0x1p259)) continue;
        std::ostringstream out;
        out << "a coordinate of " << point[axis] << "; exact are 0 and magnitudes from 2^-245 to 2^259";
        return out.str();
    }
    return {};
}

}  // namespace twinray
