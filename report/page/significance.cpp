// SPDX-License-Identifier: MIT
#include "report/page/significance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace twinray::report {
namespace {

double log_choose(double n, double k) { return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1); }

}  // namespace

double fisher_exact(std::uint64_t count_a, std::uint64_t n_a, std::uint64_t count_b, std::uint64_t n_b) {
    const auto a = static_cast<double>(n_a), b = static_cast<double>(n_b);
    const std::uint64_t count = count_a + count_b;
    const double all = log_choose(a + b, static_cast<double>(count));
    const auto log_p = [&](std::uint64_t k) {
        return log_choose(a, static_cast<double>(k)) + log_choose(b, static_cast<double>(count - k)) - all;
    };
    const double seen = log_p(count_a), slack = 1e-7;  // of rounding
    double p = 0;
    for (std::uint64_t k = count > n_b ? count - n_b : 0; k <= std::min(count, n_a); ++k)
        if (const double here = log_p(k); here <= seen + slack) p += std::exp(here);
    return std::min(p, 1.0);
}

std::vector<bool> holm(std::span<const double> p, double level) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<bool> is_refuted(p.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (p[order[i]] > level / static_cast<double>(p.size() - i)) break;
        is_refuted[order[i]] = true;
    }
    return is_refuted;
}

double sign_test(std::size_t ups, std::size_t downs) {
    const std::size_t n = ups + downs, fewer = std::min(ups, downs);
    double tail = 0;
    for (std::size_t k = 0; k <= fewer; ++k)
        tail += std::exp(log_choose(static_cast<double>(n), static_cast<double>(k)) -
                         static_cast<double>(n) * std::log(2.0));
    return std::min(2 * tail, 1.0);
}

}  // namespace twinray::report
