#include "engine/analysis/pair_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

#include "analysis_pair_rays.spv.h"
#include "analysis_pair_weights.spv.h"

namespace twinray {
namespace {

constexpr std::size_t pair_chunks_of_batch = 1 << 13;

}  // namespace

PairSampler::PairSampler(AbstractAccel& accel, const Faces& faces, Sides sides, Sequence sequence, uint seed)
    : accel_(accel),
      faces_(faces),
      sides_(sides),
      sequence_(sequence),
      seed_(seed),
      make_rays_(accel.context(), {.name = "analysis_pair_rays", .spirv = analysis_pair_rays_spirv}),
      mark_blocked_(accel.context(), {.name = "analysis_pair_weights", .spirv = analysis_pair_weights_spirv}),
      pace_(accel.context()) {
    constexpr std::uint64_t rays = pair_chunks_of_batch * CHUNK;
    Context& context = accel.context();
    chunks_ = Buffer(
        context,
        {.name = "chunks of pairs", .bytes = pair_chunks_of_batch * sizeof(PairChunk), .memory = Memory::upload});
    rays_ = Buffer(context, {.name = "rays of pairs", .bytes = rays * sizeof(Ray)});
    hits_ = Buffer(context, {.name = "hits of pairs", .bytes = rays * sizeof(Hit)});
    weights_ = Buffer(context, {.name = "weights", .bytes = rays * sizeof(float), .memory = Memory::readback});
}

void PairSampler::sample(std::span<const Pair> pairs) {
    std::vector<PairChunk> chunks;
    std::vector<const Pair*> owners;
    const auto flush = [&] {
        if (chunks.empty()) return;
        trace(chunks);
        const auto* weights = reinterpret_cast<const float*>(weights_.mapped());
        for (std::size_t i = 0; i < chunks.size(); ++i) {
            const Pair& pair = *owners[i];
            const auto& [a, b, part_a, part_b, fraction, distance, unblocked, may_be_blocked] = *pair.faces;
            const double unit =
                pair.share * fraction * faces_.areas()[a] / distance * faces_.areas()[b] / distance / std::numbers::pi;
            pair.sums->add({weights + i * CHUNK, CHUNK}, unit);
        }
        chunks.clear();
        owners.clear();
    };
    for (const Pair& pair : pairs)
        for (std::uint64_t chunk = pair.first; chunk < pair.last; ++chunk) {
            const SampledPair& faces = *pair.faces;
            chunks.push_back({faces.a, faces.b, static_cast<uint>(chunk * SAMPLES_OF_CHUNK),
                              static_cast<float>(faces.distance), faces.part_a, faces.part_b});
            owners.push_back(&pair);
            if (chunks.size() == pair_chunks_of_batch) flush();
        }
    flush();
}

void PairSampler::trace(std::span<const PairChunk> chunks) {
    std::memcpy(chunks_.mapped(), chunks.data(), chunks.size_bytes());
    const std::uint64_t count = chunks.size() * CHUNK;
    const auto rays = rays_.ref<Ray>();
    const auto hits = hits_.ref<Hit>();
    const auto weights = weights_.ref<float>();
    Commands commands(accel_.context(), "area to area");
    make_rays_.dispatch(commands,
                        {faces_.state().table(), chunks_.ref<PairChunk>(), rays, weights, seed_,
                         sequence_ == Sequence::sobol ? SEQUENCE_SOBOL : SEQUENCE_RANDOM, sides_ == Sides::both, 0},
                        count);
    accel_.trace(commands, accel_.view(),
                 {.rays = rays, .hits = hits, .count = count, .query = Query::any, .occlusion_only = true}, pace_);
    mark_blocked_.dispatch(commands, {hits, weights, static_cast<uint>(count), 0}, count);
    pace_.finish(commands);
}

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
