// SPDX-License-Identifier: MIT
// Features of SwTlas's kernel that a scene may not need, in the order in which measurements add them.
#pragma once

#include <array>

#include "engine/accel/trace_desc.h"

namespace twinray {

struct FeatureAddition {
    const char* name;
    uint features;
};
// Ordered from the most often needed to the rarest.
inline constexpr std::array feature_additions = {
    FeatureAddition{"+ hits", FEATURE_HITS},
    FeatureAddition{"+ transforms", FEATURE_TRANSFORMS},
    FeatureAddition{"+ instances", FEATURE_INSTANCES},
    FeatureAddition{"+ masks", FEATURE_MASKS},
    FeatureAddition{"+ culling", FEATURE_CULLING},
    FeatureAddition{"+ filters", FEATURE_FILTERS},
    FeatureAddition{"+ boxes", FEATURE_BOXES},
    FeatureAddition{"+ other layouts", FEATURE_BVH2 | FEATURE_COMPRESSED | FEATURE_COMPRESSED8}};

}  // namespace twinray
