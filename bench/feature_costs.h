// SPDX-License-Identifier: MIT
// What each feature of shaders/shared/features.h costs a scene that does not need it.
#pragma once

#include <nlohmann/json.hpp>

#include <ostream>

#include "bench/run.h"

namespace twinray::bench {

struct FeatureCostOptions {
    Layout layout = Layout::compressed4;
    Level level = Level::watertight;
    std::size_t rounds = 9;  // at least 5
    std::uint64_t seed = 1;
    uint width = 256;  // as RunOptions::width
};

// One set of rays, traced by programs for the same scene that bits of FEATURES are added to, one after the other. The
// first has those alone that the trace needs.
struct FeatureCosts {
    struct Step {
        std::string name;  // "needed", "+ masks"
        uint features = 0;
        TraceRounds rounds;
    };
    RayKind kind;
    std::vector<Step> steps;

    // Median over the rounds of its time over that of the first.
    double ratio(std::size_t step) const;
    // Whether all of them found the same.
    bool agrees() const;
};

// By SwTlas, of scenes whose instances do not move. Throws Error naming the scene if no primary ray meets it.
std::vector<FeatureCosts> measure_feature_costs(Context& context, const BenchScene& scene,
                                                const FeatureCostOptions& options, std::span<const RayKind> kinds);

void print_feature_costs(std::ostream& out, const FeatureCosts& costs);
// One for each step, added to the fields of `base`.
std::vector<nlohmann::json> records_of(const nlohmann::json& base, const FeatureCosts& costs);

}  // namespace twinray::bench
