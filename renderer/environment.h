// SPDX-License-Identifier: MIT
// Light from all around: maps and a sky, and how they are sampled.
#pragma once

#include <filesystem>
#include <vector>

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// Light from infinitely far away, as a latitude-longitude map, ready to be sampled.
struct EnvironmentMap {
    HdrImage image;
    // See Environment in shaders/path_tracer/scene.h; no sums for a black map.
    std::vector<float> row_sums, column_sums;
    float density_per_luminance = 0;

    explicit EnvironmentMap(HdrImage map);
    bool is_black() const { return row_sums.empty(); }
};

// The same radiance from everywhere.
HdrImage constant_sky(vec3 radiance);

// For scenes without any light: a blue gradient over a grey ground, with a soft sun high to the front left.
HdrImage default_sky();

}  // namespace twinray::path_tracer
