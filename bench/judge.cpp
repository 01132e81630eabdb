// SPDX-License-Identifier: MIT
#include "bench/judge.h"

#include <algorithm>

#include "engine/verify/classify.h"
#include "engine/core/parallel.h"

namespace twinray::bench {
namespace {

// One of every so many, `Judge::sample` of all.
template <class T>
std::vector<T> some_of(std::span<const T> all) {
    std::vector<T> some;
    for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(all.size() / Judge::sample, 1))
        some.push_back(all[i]);
    return some;
}

struct Sample {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    Query query;
    bool is_ours;
};

std::vector<Verdict> verdicts_of(const Oracle& oracle, const Sample& sample) {
    const auto& [rays, hits, query, is_ours] = sample;
    const std::span<const Hit> none;
    if (query == Query::closest)
        return is_ours ? classify_all(oracle, rays, hits, none) : classify_all(oracle, rays, none, hits);
    std::vector<Verdict> verdicts(rays.size());
    parallel_for(verdicts.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const bool is_hit = sample.hits[i].hit != 0;
            verdicts[i] = sample.is_ours ? classify_any(oracle, sample.rays[i], is_hit, {})
                                         : classify_any(oracle, sample.rays[i], {}, is_hit);
        }
    });
    return verdicts;
}

}  // namespace

Soundness Judge::judge(std::span<const Ray> rays, std::span<const Hit> hits, Query query, bool is_ours) const {
    Classes classes;
    for (const Verdict& verdict : verdicts_of(oracle_, {some_of(rays), some_of(hits), query, is_ours}))
        classes.add(is_ours ? *verdict.software : *verdict.hardware);
    const auto right = static_cast<double>(classes[Class::agree] + classes[Class::tie]);
    return {classes.total(), right / static_cast<double>(classes.total()),
            is_ours ? classes.faults_of_ours() : classes.faults_of_hardware()};
}

}  // namespace twinray::bench
