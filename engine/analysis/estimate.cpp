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

double mean_of(const Replicates& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / replicate_count;
}

}  // namespace

Estimate within(const Interval& possible, double value, const Interval& interval_95) {
    const double inside = std::clamp(value, possible.low, possible.high);
    return {inside,
            {std::clamp(interval_95.low, possible.low, inside), std::clamp(interval_95.high, inside, possible.high)}};
}

Estimate scattered(const Replicates& values) {
    const double mean = mean_of(values);
    double squares = 0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    const double half = student_975 * std::sqrt(squares / (replicate_count * (replicate_count - 1)));
    return {mean, {mean - half, mean + half}};
}

const Interval& FractionEstimator::rate(std::uint64_t events, std::uint64_t rays) {
    constexpr std::size_t most_kept = 1 << 14;
    if (rates_.size() >= most_kept) rates_.clear();
    const auto [found, is_new] = rates_.try_emplace({events, rays});
    if (is_new) found->second = rate_interval_95(events, rays);
    return found->second;
}

// `value` is `events` of so many rays as make it that fraction: not of `rays` if faces of a group weigh differently.
const Interval& FractionEstimator::counted(double value, std::uint64_t events, std::uint64_t rays) {
    if (events == 0 || events == rays) return rate(events, rays);
    const auto trials = static_cast<std::uint64_t>(std::llround(static_cast<double>(events) / value));
    return rate(events, std::max(trials, events));
}

Estimate FractionEstimator::operator()(const Replicates& fractions, std::uint64_t events, std::uint64_t rays) {
    constexpr Interval fraction = {0, 1};
    const auto [mean, scatter] = scattered(fractions);
    if (events < fewest_events || rays - events < fewest_events)
        return within(fraction, mean, counted(mean, events, rays));
    const double unseen = rate(0, rays).high;
    return within(fraction, mean, {std::min(scatter.low, mean - unseen), std::max(scatter.high, mean + unseen)});
}

}  // namespace twinray
