// SPDX-License-Identifier: MIT
#include "engine/analysis/pair_sums.h"

#include <algorithm>
#include <cmath>

namespace twinray {

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
    constexpr std::uint64_t fewest = 10;
    Estimate estimate = scattered_of(free_);
    Interval& interval = estimate.interval_95;
    if (may_be_blocked && free_count_ < fewest) {
        const Interval rate = rate_interval_95(free_count_, rays_);
        interval = {std::min(estimate.value, rate.low * lightest_free_),
                    std::max(estimate.value, rate.high * heaviest_)};
    } else if (may_be_blocked && blocked_count_ < fewest) {
        const Interval of_all = scattered_of(all_).interval_95;
        const double blocked = rate_interval_95(blocked_count_, rays_).high * heaviest_;
        interval = {std::min(estimate.value, of_all.low - blocked), std::max(estimate.value, of_all.high)};
    }
    interval.low = std::max(0.0, interval.low);
    return estimate;
}

}  // namespace twinray
