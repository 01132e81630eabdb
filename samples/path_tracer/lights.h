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
    std::vector<AliasEntry> table;  // emitters, then punctual

    bool empty() const { return table.empty(); }
};

LocalLights collect_lights(const Scene& scene);

// Whether the scene brings light to see by: a punctual light, or a surface brighter than the radiance 1 that glTF
// allows without KHR_materials_emissive_strength, which is the glow of a label or a screen rather than a lamp.
bool has_lamps(const Scene& scene);

}  // namespace twinray::path_tracer
