// SPDX-License-Identifier: MIT
#include "report/suite/schedule.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "report/frame/cases.h"

namespace twinray::suite {

double uncertainty_of(std::span<const Record> records) {
    double widest = 0;
    for (const Record& record : records) {
        if (!record.was_run || !record.pass || record.n == 0 || frame::is_control(record)) continue;
        const Interval rate = rate_interval_95(record.faults, record.n);
        widest = std::max(widest, (rate.high - rate.low) / 2);
    }
    return widest;
}

CaseProgress after_step(const CaseProgress& before, double seconds, double uncertainty) {
    const double least_gain = 0.9;  // of the uncertainty before
    return {.effort = before.effort + effort_step,
            .seconds = seconds,
            .growth = before.seconds > 0 ? std::max(1.0, seconds / before.seconds) : before.growth,
            .uncertainty = uncertainty,
            .can_improve = uncertainty < least_gain * before.uncertainty};
}

std::optional<std::size_t> next_to_improve(std::span<const CaseProgress> cases, double seconds_left) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const CaseProgress& here = cases[i];
        if (!here.can_improve || here.uncertainty <= 0 || here.effort >= 1) continue;
        if (here.seconds * here.growth > seconds_left) continue;
        if (!best || here.uncertainty > cases[*best].uncertainty) best = i;
    }
    return best;
}

std::vector<std::size_t> by_turns(std::span<const char> sections) {
    std::map<char, std::size_t> counts;
    std::vector<std::size_t> turns;
    for (const char section : sections) turns.push_back(counts[section]++);
    std::vector<std::size_t> order(sections.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return turns[a] < turns[b]; });
    return order;
}

}  // namespace twinray::suite
