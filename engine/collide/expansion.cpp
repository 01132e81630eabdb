// SPDX-License-Identifier: MIT
#include "engine/collide/expansion.h"

#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/exact_double.h"
#include "twinray/glsl/cpp_end.h"

// The rounding error of the sum s = fl(a + b) (Knuth's TwoSum).
double sum_error(double a, double b, double s) {
    const double b_virtual = s - a;
    const double a_virtual = s - b_virtual;
    return (a - a_virtual) + (b - b_virtual);
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

}  // namespace twinray
