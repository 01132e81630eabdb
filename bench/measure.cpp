#include "bench/measure.h"

#include <algorithm>

#include "engine/core/fnv1a.h"
#include "engine/core/parallel.h"
#include "validation/reference/classify.h"

namespace twinray::bench {
namespace {

RayBatch part_of(const RayBatch& rays, std::size_t tiles) {
    return {even_tiles(rays.rays(), tiles), rays.query(), rays.is_coherent()};
}

// The traces of one backend.
class Turn {
  public:
    Turn(Backend& backend, const RayBatch& rays, double max_ms) : backend_(backend), all_(rays) {
        const std::size_t tiles = affordable_tiles(backend, rays, max_ms);
        if (tiles < count_tiles(rays.rays().size())) part_ = part_of(rays, tiles);
    }

    // Makes the first trace: its time does not count, its hits do.
    TraceRounds warm_up(const HitCheck* hit_check) {
        backend_.trace(batch());
        const std::vector<Hit> hits = backend_.hits(batch());
        TraceRounds rounds{.n = hits.size(), .ns_per_ray = {}, .hash = {}, .soundness = {}};
        if (!part_) rounds.hash = hash_of(hits, all_.query());
        const bool is_ours = backend_.labels().backend == "sw";
        if (hit_check) rounds.soundness = hit_check->check(batch().rays(), hits, all_.query(), is_ours);
        return rounds;
    }

    double ns_per_ray() { return backend_.trace(batch()) * 1e6 / static_cast<double>(batch().rays().size()); }

  private:
    const RayBatch& batch() const { return part_ ? *part_ : all_; }

    Backend& backend_;
    const RayBatch& all_;
    std::optional<RayBatch> part_;
};

// Returns items at even steps, `HitCheck::sample` of all.
template <class T>
std::vector<T> some_of(std::span<const T> all) {
    std::vector<T> some;
    for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(all.size() / HitCheck::sample, 1))
        some.push_back(all[i]);
    return some;
}

struct Sample {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    Query query;
    bool is_ours;
};

std::vector<RayResult> results_of(const ReferenceScene& reference, const Sample& sample) {
    const auto& [rays, hits, query, is_ours] = sample;
    const std::span<const Hit> none;
    if (query == Query::closest)
        return is_ours ? classify_all(reference, rays, hits, none) : classify_all(reference, rays, none, hits);
    std::vector<RayResult> ray_results(rays.size());
    parallel_for(ray_results.size(), [&](std::size_t i) {
        const bool is_hit = sample.hits[i].hit != 0;
        ray_results[i] = sample.is_ours ? classify_any(reference, sample.rays[i], is_hit, {})
                                        : classify_any(reference, sample.rays[i], {}, is_hit);
    });
    return ray_results;
}

}  // namespace

Soundness HitCheck::check(std::span<const Ray> rays, std::span<const Hit> hits, Query query, bool is_ours) const {
    HitClassCounts classes;
    for (const RayResult& ray_result : results_of(reference_, {some_of(rays), some_of(hits), query, is_ours}))
        classes.add(is_ours ? *ray_result.software : *ray_result.hardware);
    const auto right = static_cast<double>(classes[HitClass::agree] + classes[HitClass::tie]);
    return {classes.total(), right / static_cast<double>(classes.total()),
            is_ours ? classes.faults_of_ours() : classes.faults_of_hardware()};
}

std::vector<BuildRounds> measure_builds(LineUp& line_up, const Scene& scene, std::size_t rounds, const Step& step) {
    std::vector<BuildRounds> results(line_up.size());
    for (std::size_t round = 0; round <= rounds; ++round)
        for (std::size_t i = 0; i < line_up.size(); ++i) {
            results[i].last = line_up[i]->build(scene);
            step();
            if (round == 0) continue;
            results[i].ms.push_back(results[i].last.ms);
            results[i].wall_ms.push_back(results[i].last.wall_ms);
        }
    return results;
}

std::vector<TraceRounds> measure_traces(LineUp& line_up, const RayBatch& rays, const TraceSettings& settings,
                                        const Step& step) {
    std::vector<Turn> turns;
    std::vector<TraceRounds> results;
    for (const auto& backend : line_up) {
        turns.emplace_back(*backend, rays, settings.max_ms);
        results.push_back(turns.back().warm_up(settings.hit_check));
        step();
    }
    for (std::size_t round = 0; round < settings.rounds; ++round)
        for (std::size_t i = 0; i < turns.size(); ++i) {
            results[i].ns_per_ray.push_back(turns[i].ns_per_ray());
            step();
        }
    return results;
}

std::uint64_t hash_of(std::span<const Hit> hits, Query query) {
    Fnv1a hash;
    for (const Hit& hit : hits) {
        hash.add_bytes(std::span(&hit.hit, 1));
        if (query == Query::any) continue;
        for (const uint index : {hit.primitive_index, hit.instance_index}) hash.add_bytes(std::span(&index, 1));
        for (const float value : {hit.t, hit.u, hit.v}) hash.add_bytes(std::span(&value, 1));
    }
    return hash.value();
}

std::size_t count_tiles(std::size_t count) { return (count + rays_a_tile - 1) / rays_a_tile; }

std::vector<Ray> even_tiles(std::span<const Ray> rays, std::size_t wanted) {
    const std::size_t all = count_tiles(rays.size());
    if (wanted >= all) return {rays.begin(), rays.end()};
    std::vector<Ray> some;
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t tile = (2 * i + 1) * all / (2 * wanted);  // the middle of each share
        const auto part = rays.subspan(tile * rays_a_tile);
        some.insert(some.end(), part.begin(),
                    part.begin() + static_cast<std::ptrdiff_t>(std::min(rays_a_tile, part.size())));
    }
    return some;
}

std::size_t affordable_tiles(Backend& backend, const RayBatch& rays, double max_ms) {
    constexpr std::size_t least = 4, growth = 16;
    const std::size_t all = count_tiles(rays.rays().size());
    backend.trace(part_of(rays, least));
    for (std::size_t tiles = std::min(least, all);; tiles *= growth) {
        const double ms = backend.trace(part_of(rays, tiles));
        const double affordable = static_cast<double>(tiles) * max_ms / std::max(ms, 1e-3);
        const std::size_t next = std::min({all, tiles * growth, static_cast<std::size_t>(affordable)});
        if (next < tiles * growth || next == all) return std::max(next, std::min(least, all));
    }
}

}  // namespace twinray::bench
