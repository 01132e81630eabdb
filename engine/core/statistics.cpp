#include "engine/core/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <ranges>
#include <utility>

namespace twinray {
namespace {

// Evaluates the continued fraction of the incomplete beta function, DLMF 8.17.22, forwards by Lentz's method.
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
    // This suffices here: it needs about sqrt(max(a, b)) terms.
    const int limit = 100 + static_cast<int>(10 * std::sqrt(std::max(a, b)));
    for (int m = 1; m <= limit; ++m) {
        const double before = fraction;
        step(m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)));
        step(-(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)));
        if (fraction == before) break;
    }
    return fraction;
}

// Returns the regularised incomplete beta I_x(a, b), 0 < x < 1; I_p(k + 1, n - k) is the chance of more than k of n.
double regularised_beta(double a, double b, double x) {
    const double log_front =
        std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
    if (x < (a + 1) / (a + b + 2)) return std::exp(log_front) * beta_fraction(a, b, x) / a;
    return 1 - std::exp(log_front) * beta_fraction(b, a, 1 - x) / b;
}

// Returns where is_low() ends between `low` and `high`.
template <class IsLow>
double bisected(double low, double high, const IsLow& is_low) {
    for (int i = 0; i < 60; ++i) {
        const double middle = low + (high - low) / 2;
        (is_low(middle) ? low : high) = middle;
    }
    return high;
}

// Returns the x in [low, 1] at which the beta distribution has the chance `chance` below it.
double beta_quantile(double a, double b, double chance, double low = 0) {
    return bisected(low, 1, [&](double p) { return regularised_beta(a, b, p) < chance; });
}

// Returns the bound below which `count` or fewer events stay with the given chance.
double upper_bound(std::uint64_t count, std::uint64_t trials, double chance) {
    if (count >= trials) return 1;
    const double n = static_cast<double>(trials);
    if (count == 0) return -std::expm1(std::log1p(-chance) / n);
    const double k = static_cast<double>(count);
    return beta_quantile(k + 1, n - k, chance, k / n);
}

// Returns the smallest k with P(at most k) >= chance for a binomial distribution of n trials.
std::size_t binomial_quantile(std::size_t n, double p, double chance) {
    const auto counts = std::views::iota(std::size_t{0}, n);
    const auto is_too_low = [&](std::size_t k) {
        return 1 - regularised_beta(static_cast<double>(k) + 1, static_cast<double>(n - k), p) < chance;
    };
    return static_cast<std::size_t>(std::ranges::partition_point(counts, is_too_low) - counts.begin());
}

// Returns the value that Student's t exceeds in 2.5 % of all cases.
double student_97_5(double degrees) {
    const auto is_low = [&](double t) {
        return regularised_beta(degrees / 2, 0.5, degrees / (degrees + t * t)) > 0.05;  // on both sides
    };
    double high = 1;
    while (is_low(high)) high *= 2;
    return bisected(0, high, is_low);
}

// A weighted mean of rates, the variance of the corresponding sum, and the most that one event adds to it.
struct Moments {
    double mean = 0, variance = 0, largest = 0;
};

Moments moments_of(std::span<const Stratum> strata) {
    double weights = 0;
    for (const Stratum& stratum : strata) weights += stratum.trials ? stratum.weight : 0;
    Moments moments;
    for (const Stratum& stratum : strata) {
        if (stratum.trials == 0) continue;
        const double of_event = stratum.weight / weights / static_cast<double>(stratum.trials);
        const double events = static_cast<double>(stratum.count);
        moments.mean += of_event * events;
        moments.variance += of_event * of_event * events;
        moments.largest = std::max(moments.largest, of_event);
    }
    return moments;
}

}  // namespace

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return quantile(values, 0.5);
}

double median_absolute_deviation(std::span<const double> values) {
    const double middle = median({values.begin(), values.end()});
    std::vector<double> deviations;
    for (const double value : values) deviations.push_back(std::abs(value - middle));
    return median(std::move(deviations));
}

double quantile(std::span<const double> sorted, double p) {
    if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
    const double position = p * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    const double between = position - static_cast<double>(below);
    if (between == 0) return sorted[below];
    return sorted[below] + between * (sorted[below + 1] - sorted[below]);
}

Interval quantile_interval_95(std::span<const double> sorted, double p) {
    const std::size_t n = sorted.size();
    if (p <= 0) return {sorted.front(), sorted.front()};
    if (p >= 1) return {sorted.back(), sorted.back()};
    // Ranks count from 1; rank k bounds the quantile from below unless fewer than k samples are under it.
    const std::size_t low = binomial_quantile(n, p, 0.025);
    const std::size_t high = binomial_quantile(n, p, 0.975) + 1;
    return {sorted[std::max<std::size_t>(low, 1) - 1], sorted[std::min(high, n) - 1]};
}

Interval bootstrap_interval_95(std::size_t n,
                               const std::function<double(std::span<const std::size_t> items)>& statistic,
                               std::uint64_t seed) {
    constexpr std::size_t draws = 1000;
    std::mt19937_64 random(seed);
    std::vector<double> values;
    std::vector<std::size_t> items(n);
    for (std::size_t draw = 0; draw < draws; ++draw) {
        for (std::size_t& item : items) item = random() % n;
        values.push_back(statistic(items));
    }
    std::sort(values.begin(), values.end());
    return {quantile(values, 0.025), quantile(values, 0.975)};
}

double upper_bound_95(std::uint64_t count, std::uint64_t trials) { return upper_bound(count, trials, 0.95); }

Interval rate_interval(std::uint64_t count, std::uint64_t trials, double miss) {
    if (trials == 0) return {0, 1};
    const double chance = 1 - miss / 2;
    return {1 - upper_bound(trials - count, trials, chance), upper_bound(count, trials, chance)};
}

double mean_rate(std::span<const Stratum> strata) {
    const Moments moments = moments_of(strata);
    return moments.largest > 0 ? moments.mean : std::numeric_limits<double>::quiet_NaN();
}

Interval mean_rate_interval(std::span<const Stratum> strata, double miss) {
    const Moments seen = moments_of(strata);
    if (seen.largest == 0) return {0, 1};
    const auto bound = [](double mean, double variance, double chance) {
        const double trials = mean / variance, events = mean * trials;
        return beta_quantile(events, std::max(trials - events + 1, 1.0), chance);
    };
    // The upper bound counts one more event, in the stratum where one adds most.
    const double mean = seen.mean + seen.largest, variance = seen.variance + seen.largest * seen.largest;
    const double low = seen.mean > 0 ? bound(seen.mean, seen.variance, miss / 2) : 0;
    return {low, seen.mean < 1 ? bound(mean, variance, 1 - miss / 2) : 1};
}

double paired_margin(double squared_differences, double most, double miss) {
    // A fifth of the chance is for the variance: a sum of independent numbers within [0, m] falls to Y from a mean of
    // at least (sqrt(Y + m L / 2) + sqrt(m L / 2))^2 with a chance of exp(-L) at most (Chernoff). The rest is for both
    // sides of the sum itself.
    const double of_variance = most * most * std::log(5 / miss) / 2;
    const double variance = std::pow(std::sqrt(squared_differences + of_variance) + std::sqrt(of_variance), 2);
    const double of_sum = std::log(2.5 / miss);
    const double linear = of_sum * most / 3;
    return linear + std::sqrt(linear * linear + 2 * of_sum * variance);
}

Interval paired_count_interval_95(std::uint64_t count, std::uint64_t odd, std::uint64_t trials) {
    const double n = static_cast<double>(trials), sum = static_cast<double>(count);
    const Interval rate = rate_interval(count, trials, 0.025);
    const double margin = paired_margin(static_cast<double>(odd), 1, 0.025);
    return {std::max({rate.low * n, sum - margin, 0.0}), std::min({rate.high * n, sum + margin, n})};
}

std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y) {
    const auto is_usable = [](double value) { return value > 0 && std::isfinite(value); };
    std::vector<std::pair<double, double>> logs;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (is_usable(x[i]) && is_usable(y[i])) logs.emplace_back(std::log(x[i]), std::log(y[i]));
    if (logs.size() < 3) return std::nullopt;
    const auto [least, most] = std::minmax_element(logs.begin(), logs.end());
    if (most->first - least->first < std::log(2.0)) return std::nullopt;
    const double n = static_cast<double>(logs.size());
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0, residual = 0;
    for (const auto& [log_x, log_y] : logs) mean_x += log_x / n, mean_y += log_y / n;
    for (const auto& [log_x, log_y] : logs) {
        xx += (log_x - mean_x) * (log_x - mean_x);
        xy += (log_x - mean_x) * (log_y - mean_y);
    }
    const double slope = xy / xx;
    for (const auto& [log_x, log_y] : logs) residual += std::pow(log_y - mean_y - slope * (log_x - mean_x), 2);
    const double margin = student_97_5(n - 2) * std::sqrt(residual / (n - 2) / xx);
    return PowerLaw{slope, std::exp(mean_y - slope * mean_x), {slope - margin, slope + margin}, logs.size()};
}

}  // namespace twinray
