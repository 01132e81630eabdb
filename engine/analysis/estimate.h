// Fractions of rays and exchanges with their errors: pure functions.
#pragma once

#include <twinray/analysis.h>

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/statistics.h"
#include "twinray/glsl/cpp.h"

namespace twinray {

inline constexpr std::size_t replicate_count = 16;
// A sum or a mean for each independent replicate of a sequence, all of them equally long.
using Replicates = std::array<double, replicate_count>;

inline constexpr std::uint64_t first_rays = 1024;  // before the first look at errors

// Restricts an estimate to the interval `possible`: neither the value nor its interval leaves that, and the interval
// holds the value.
Estimate within(const Interval& possible, double value, const Interval& interval_95);

// Returns the mean of replicates, with Student's 95 % interval for their scatter.
Estimate scattered(const Replicates& values);

// Estimates fractions in [0, 1] as the means of their replicates, `events` rays of `rays` in all. The interval is
// Student's for their scatter, within [0, 1]; if fewer than 10 rays, or all but as many, had the event, replicates are
// too few to scatter as they should, and it is that of Clopper and Pearson (1934), never too short for independent or
// stratified rays. No interval is shorter than some 3.7 / rays either way, which no ray may have seen: replicates of
// stratified rays can all agree. Intervals of counts take long to compute and recur: they are kept.
class FractionEstimator {
  public:
    Estimate operator()(const Replicates& fractions, std::uint64_t events, std::uint64_t rays);

  private:
    const Interval& rate(std::uint64_t events, std::uint64_t rays);
    const Interval& counted(double value, std::uint64_t events, std::uint64_t rays);

    std::map<std::pair<std::uint64_t, std::uint64_t>, Interval> rates_;
};

// The hits so far of the rays of one row of view factors.
class RowSums {
  public:
    struct Entry {
        uint target;
        std::uint64_t hits;
        Replicates sums;  // of weights
    };

    // Adds a chunk of rays (see shaders/analysis/view_factors.h), each of which counts as `weight`. Order does not
    // matter but for rounding; weights that are powers of two do not round.
    void add(std::span<const uint> targets, double weight);
    // Merges the added chunks; the rest is then up to date.
    void settle();

    std::uint64_t rays() const { return rays_; }
    const std::vector<Entry>& entries() const { return entries_; }  // ascending by target
    // `total_weight`: of all rays of a replicate.
    Estimate estimate(const Entry& entry, double total_weight, FractionEstimator& estimator) const;

  private:
    struct Added {
        uint target;
        uint replicate;
        double weight;
    };
    std::vector<Added> added_;
    std::vector<Entry> entries_;
    std::uint64_t rays_ = 0;
};

// The results so far of rays between points of faces, for their exchange.
class PairSums {
  public:
    // Adds a chunk of rays (see shaders/analysis/pair_rays.h): the exchange by each if it were the only one, before
    // `unit`; negative if it is blocked.
    void add(std::span<const float> weights, double unit);

    std::uint64_t rays() const { return rays_; }
    // Returns the mean, with the 95 % interval of Student's distribution for the scatter of the replicates. If an
    // obstacle is possible, but fewer than 10 rays are blocked, or fewer than 10 free, replicates are too few to tell:
    // the interval then has room for the rate of Clopper and Pearson, of rays as heavy as the heaviest.
    Estimate exchange(bool may_be_blocked) const;

  private:
    Estimate scattered_of(Replicates sums) const;

    Replicates all_ = {}, free_ = {};
    std::uint64_t rays_ = 0, free_count_ = 0, blocked_count_ = 0;
    double lightest_free_ = 0, heaviest_ = 0;
};

}  // namespace twinray
