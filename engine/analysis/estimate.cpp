// SPDX-License-Identifier: MIT
#include "engine/analysis/estimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace twinray {
namespace {

constexpr double student_975 = 2.131449545559323;  // quantile of Student's distribution with 15 degrees of freedom
constexpr std::uint64_t fewest_events = 10;
static_assert(replicate_count == 16);

Interval scattered(const Replicates& fractions, double mean) {
    double squares = 0;
    for (const double fraction : fractions) squares += (fraction - mean) * (fraction - mean);
    const double half = student_975 * std::sqrt(squares / (replicate_count * (replicate_count - 1)));
    return {std::max(0.0, mean - half), std::min(1.0, mean + half)};
}

}  // namespace

const Interval& Estimator::rate(std::uint64_t events, std::uint64_t rays) {
    constexpr std::size_t most_kept = 1 << 14;
    if (rates_.size() >= most_kept) rates_.clear();
    const auto [found, is_new] = rates_.try_emplace({events, rays});
    if (is_new) found->second = rate_interval_95(events, rays);
    return found->second;
}

// `value` is `events` of so many rays as make it that fraction: not of `rays` where faces of a group weigh differently.
Interval Estimator::counted(double value, std::uint64_t events, std::uint64_t rays) {
    if (events == 0 || events == rays) return rate(events, rays);
    const auto trials = static_cast<std::uint64_t>(std::llround(static_cast<double>(events) / value));
    const Interval& interval = rate(events, std::max(trials, events));
    return {std::min(interval.low, value), std::max(interval.high, value)};
}

Estimate Estimator::operator()(const Replicates& fractions, std::uint64_t events, std::uint64_t rays) {
    const double mean = std::accumulate(fractions.begin(), fractions.end(), 0.0) / replicate_count;
    const bool is_rare = events < fewest_events || rays - events < fewest_events;
    return {mean, is_rare ? counted(mean, events, rays) : scattered(fractions, mean)};
}

}  // namespace twinray
