// Light from all directions: maps and a sky, and their sampling.
#pragma once

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

// Makes a sky of the same radiance from everywhere.
HdrImage constant_sky(vec3 radiance);

// Makes a sky for scenes without any light: a blue gradient over a grey ground, with a soft sun high to the front left.
HdrImage default_sky();

}  // namespace twinray::path_tracer
