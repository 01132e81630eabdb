// SPDX-License-Identifier: MIT
#include "engine/analysis/pair_sampler.h"

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

}  // namespace twinray
