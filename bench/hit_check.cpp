// SPDX-License-Identifier: MIT
#include "bench/hit_check.h"

#include <algorithm>

#include "validation/reference/classify.h"
#include "engine/core/parallel.h"

namespace twinray::bench {
namespace {

// One of every so many, `HitCheck::sample` of all.
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

}  // namespace twinray::bench
