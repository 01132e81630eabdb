// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "engine/scene/scene.h"
#include "samples/path_tracer/shared.h"

namespace twinray::path_tracer {

// The emissive triangles and punctual lights of a scene, each chosen with a probability proportional to an estimate of
// its power (as pbrt-v4's power light sampler).
struct LocalLights {
    std::vector<Emitter> emitters;
    std::vector<std::vector<float>> densities;  // per instance, then triangle: probability / world area; empty if dark
    std::vector<PunctualLight> punctual;
    std::vector<AliasEntry> table;              // emitters, then punctual

    bool empty() const { return table.empty(); }
};

LocalLights collect_lights(const Scene& scene);

}  // namespace twinray::path_tracer
