#include "engine/analysis/estimate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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

void RowSums::add(std::span<const uint> targets, double weight) {
    const std::size_t of_replicate = targets.size() / replicate_count;
    for (std::size_t i = 0; i < targets.size(); ++i)
        added_.push_back({targets[i], static_cast<uint>(i / of_replicate), weight});
    rays_ += targets.size();
}

void RowSums::settle() {
    std::stable_sort(added_.begin(), added_.end(), [](const Added& a, const Added& b) { return a.target < b.target; });
    std::vector<Entry> joined;
    auto old = entries_.begin();
    for (auto first = added_.begin(); first != added_.end();) {
        const uint target = first->target;
        while (old != entries_.end() && old->target < target) joined.push_back(*old++);
        Entry entry{target, 0, {}};
        if (old != entries_.end() && old->target == target) entry = *old++;
        for (; first != added_.end() && first->target == target; ++first) {
            entry.hits += 1;
            entry.sums[first->replicate] += first->weight;
        }
        joined.push_back(entry);
    }
    std::copy(old, entries_.end(), std::back_inserter(joined));
    entries_ = std::move(joined);
    added_.clear();
}

Estimate RowSums::estimate(const Entry& entry, double total_weight, FractionEstimator& estimator) const {
    Replicates fractions;
    for (std::size_t i = 0; i < replicate_count; ++i) fractions[i] = entry.sums[i] / total_weight;
    return estimator(fractions, entry.hits, rays_);
}

void PairSums::add(std::span<const float> weights, double unit) {
    const std::size_t of_replicate = weights.size() / replicate_count;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0) continue;
        const double part = std::abs(static_cast<double>(weights[i])) * unit;
        all_[i / of_replicate] += part;
        heaviest_ = std::max(heaviest_, part);
        if (weights[i] < 0) {
            ++blocked_count_;
            continue;
        }
        free_[i / of_replicate] += part;
        lightest_free_ = free_count_++ ? std::min(lightest_free_, part) : part;
    }
    rays_ += weights.size();
}

Estimate PairSums::scattered_of(Replicates sums) const {
    for (double& sum : sums) sum *= static_cast<double>(replicate_count) / static_cast<double>(rays_);
    return scattered(sums);
}

Estimate PairSums::exchange(bool may_be_blocked) const {
    Estimate estimate = scattered_of(free_);
    Interval& interval = estimate.interval_95;
    if (may_be_blocked && free_count_ < fewest_events) {
        const Interval rate = rate_interval_95(free_count_, rays_);
        interval = {std::min(estimate.value, rate.low * lightest_free_),
                    std::max(estimate.value, rate.high * heaviest_)};
    } else if (may_be_blocked && blocked_count_ < fewest_events) {
        const Interval of_all = scattered_of(all_).interval_95;
        const double blocked = rate_interval_95(blocked_count_, rays_).high * heaviest_;
        interval = {std::min(estimate.value, of_all.low - blocked), std::max(estimate.value, of_all.high)};
    }
    interval.low = std::max(0.0, interval.low);
    return estimate;
}

}  // namespace twinray
