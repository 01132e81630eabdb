// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "engine/scene/image.h"
#include "samples/path_tracer/shared.h"

namespace twinray::path_tracer {

// Light from infinitely far away, as a latitude-longitude map, ready to be sampled.
struct EnvironmentMap {
    HdrImage image;
    std::vector<AliasEntry> table;     // over the pixels, by luminance times solid angle; empty for a black map
    float density_per_luminance = 0;   // see Environment in shaders/path_tracer/scene.h

    explicit EnvironmentMap(HdrImage map);
};

// The same radiance from everywhere.
HdrImage constant_sky(vec3 radiance);

// For scenes without any light: a blue gradient over a grey ground, with a soft sun high to the front left.
HdrImage default_sky();

}  // namespace twinray::path_tracer
