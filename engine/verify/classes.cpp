// SPDX-License-Identifier: MIT
#include "engine/verify/classes.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace twinray {
namespace {

// Continued fraction of the incomplete beta function, DLMF 8.17.22, evaluated forwards by Lentz's method.
double beta_fraction(double a, double b, double x) {
    constexpr double tiny = std::numeric_limits<double>::min();
    const auto not_zero = [](double value) { return value == 0 ? tiny : value; };
    double c = 1;
    double d = 1 / not_zero(1 - (a + b) * x / (a + 1));
    double fraction = d;
    const auto step = [&](double term) {
        d = 1 / not_zero(1 + term * d);
        c = not_zero(1 + term / c);
        fraction *= c * d;
    };
    // It needs about sqrt(max(a, b)) terms where it is used.
    const int limit = 100 + static_cast<int>(10 * std::sqrt(std::max(a, b)));
    for (int m = 1; m <= limit; ++m) {
        const double before = fraction;
        step(m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)));
        step(-(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)));
        if (fraction == before) break;
    }
    return fraction;
}

// Regularised incomplete beta function I_x(a, b), 0 < x < 1; I_p(k + 1, n - k) is the chance of more than k of n.
double regularised_beta(double a, double b, double x) {
    const double log_front =
        std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
    if (x < (a + 1) / (a + b + 2)) return std::exp(log_front) * beta_fraction(a, b, x) / a;
    return 1 - std::exp(log_front) * beta_fraction(b, a, 1 - x) / b;
}

}  // namespace

std::string_view name(Class kind) {
    static constexpr std::array<std::string_view, class_count> names = {
        "AGREE",    "TIE",   "BOUNDARY", "BOUNDARY_HW_MISS", "UNSPECIFIED", "INVALID_INPUT", "SW_LEAK",
        "SW_FALSE", "T_ERR", "HW_LEAK",  "HW_FALSE",         "HW_T_ERR",    "HW_RANGE"};
    return names[static_cast<std::size_t>(kind)];
}

bool is_fault_of_ours(Class kind) { return kind == Class::sw_leak || kind == Class::sw_false || kind == Class::t_err; }

Classes& Classes::operator+=(const Classes& other) {
    for (std::size_t i = 0; i < class_count; ++i) counts[i] += other.counts[i];
    return *this;
}

std::uint64_t Classes::total() const { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

std::uint64_t Classes::faults_of_ours() const {
    return (*this)[Class::sw_leak] + (*this)[Class::sw_false] + (*this)[Class::t_err];
}

std::uint64_t Classes::faults_of_hardware() const {
    return (*this)[Class::hw_leak] + (*this)[Class::hw_false] + (*this)[Class::hw_t_err] + (*this)[Class::hw_range];
}

double upper_bound_95(std::uint64_t count, std::uint64_t trials) {
    if (count >= trials) return 1;
    const double n = static_cast<double>(trials);
    if (count == 0) return -std::expm1(std::log(0.05) / n);
    const double k = static_cast<double>(count);
    double low = k / n;
    double high = 1;
    for (int i = 0; i < 60; ++i) {
        const double p = low + (high - low) / 2;
        (regularised_beta(k + 1, n - k, p) < 0.95 ? low : high) = p;
    }
    return high;
}

}  // namespace twinray
