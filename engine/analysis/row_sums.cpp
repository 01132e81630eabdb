// SPDX-License-Identifier: MIT
#include "engine/analysis/row_sums.h"

#include <algorithm>
#include <iterator>

namespace twinray {

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

}  // namespace twinray
