// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/analysis/pair_plan.h"
#include "engine/analysis/pair_sampler.h"

namespace twinray {
namespace {

// The rays of a pair of groups so far.
struct Sampling {
    const PlannedPair* pair;
    bool may_be_blocked;
    std::uint64_t most_rounds;  // of 64 rays for each two faces; a power of two
    double target;              // half of the interval's length; 0: all rounds at once
    std::uint64_t rounds = 0;
    PairSums sums = {};

    std::uint64_t next_rounds() const {
        if (rounds == most_rounds) return rounds;
        if (target == 0) return most_rounds;
        if (rounds == 0) {
            const std::uint64_t first = std::bit_floor(first_rays / (CHUNK * pair->sampled.size()));
            return std::clamp<std::uint64_t>(first, 1, most_rounds);
        }
        return sums.exchange(may_be_blocked).half_width() <= target ? rounds : rounds * 2;
    }
};

// Returns the number of sampled pairs of each group.
std::vector<std::uint64_t> sampled_pairs_of(const PairPlan& plan, std::size_t groups) {
    std::vector<std::uint64_t> counts(groups);
    for (const PlannedPair& pair : plan.pairs) {
        if (pair.sampled.empty()) continue;
        ++counts[pair.i];
        if (pair.i != pair.j) ++counts[pair.j];
    }
    return counts;
}

// Returns the rounds that keep the interval below that of hits. With M rays, hardly one of which is blocked, it reaches
// some 4 / M of F times the ratio of the heaviest ray to the mean, which is 4 at most if faces are a quarter of their
// size apart; that of hits reaches 2 sqrt(F / N). A row's pairs need no more than 8 sqrt(pairs * N) together.
std::uint64_t least_rounds(const PlannedPair& pair, double area, std::uint64_t rays_of_row) {
    double flow = 0;
    for (const SampledPair& faces : pair.sampled) flow += faces.unblocked;
    const double least = 8 * std::sqrt(flow / area * static_cast<double>(rays_of_row));
    const auto chunks = static_cast<std::uint64_t>(least / static_cast<double>(CHUNK * pair.sampled.size()));
    return std::bit_ceil(chunks + 1);
}

std::vector<Sampling> samplings_of(const PairPlan& plan, const std::vector<double>& areas,
                                   const ViewFactorOptions& options) {
    const std::vector<std::uint64_t> counts = sampled_pairs_of(plan, areas.size());
    std::vector<Sampling> samplings;
    for (const PlannedPair& pair : plan.pairs) {
        if (pair.sampled.empty()) continue;
        const std::uint64_t rays = options.rays / std::max(counts[pair.i], counts[pair.j]);
        const double area = std::min(areas[pair.i], areas[pair.j]);
        const std::uint64_t rounds =
            std::max(std::bit_floor(rays / (CHUNK * pair.sampled.size())), least_rounds(pair, area, options.rays));
        const bool may_be_blocked = std::any_of(pair.sampled.begin(), pair.sampled.end(),
                                                [](const SampledPair& faces) { return faces.may_be_blocked; });
        samplings.push_back({&pair, may_be_blocked, rounds, options.target_error.value_or(0) * area});
    }
    return samplings;
}

void sample(std::vector<Sampling>& samplings, PairSampler& sampler) {
    for (;;) {
        std::vector<PairSampler::Pair> pairs;
        for (Sampling& sampling : samplings) {
            const std::uint64_t next = sampling.next_rounds();
            if (next == sampling.rounds) continue;
            const PlannedPair& pair = *sampling.pair;
            const double share = static_cast<double>(pair.sampled.size()) * (pair.i == pair.j ? 2 : 1);
            for (const SampledPair& faces : pair.sampled)
                pairs.push_back({&faces, share, sampling.rounds, next, &sampling.sums});
            sampling.rounds = next;
        }
        if (pairs.empty()) return;
        sampler.sample(pairs);
    }
}

// Neither group exchanges more than it sends in all.
KnownExchange exchange_of(const PlannedPair& pair, const Estimate& sampled, const std::vector<double>& areas) {
    const auto [flow, error, evaluations] = pair.contour;
    const auto [value, interval] =
        within({0, std::min(areas[pair.i], areas[pair.j])}, flow + sampled.value,
               {flow - error + sampled.interval_95.low, flow + error + sampled.interval_95.high});
    const PairEstimator by = pair.sampled.empty() ? PairEstimator::contour : PairEstimator::area;
    return {pair.i, pair.j, value, interval.low, interval.high, by};
}

}  // namespace

PairExchanges exchanges_of_pairs(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                                 PairEstimator estimator, const ProgressCallback& progress) {
    check_faces(accel, faces, "exchanges of pairs");
    const std::vector<std::vector<uint>> members = faces.members(options.grouping);
    const PairPlan plan =
        plan_pairs(FacePolygons(faces.state().placed), members, {estimator, options.sides, options.rays}, progress);
    const std::vector<double> areas = faces.areas_of(members);
    std::vector<Sampling> samplings = samplings_of(plan, areas, options);
    if (!samplings.empty()) {
        accel.sync();
        PairSampler sampler(accel, faces, options.sides, options.sequence, options.seed);
        sample(samplings, sampler);
    }
    PairExchanges result;
    result.left_to_hits = plan.left_to_hits;
    auto sampling = samplings.begin();
    for (const PlannedPair& pair : plan.pairs) {
        Estimate sampled;
        if (!pair.sampled.empty()) {
            sampled = sampling->sums.exchange(sampling->may_be_blocked);
            result.rays += sampling->sums.rays();
            ++sampling;
        }
        result.known.push_back(exchange_of(pair, sampled, areas));
    }
    return result;
}

}  // namespace twinray
