// SPDX-License-Identifier: MIT
// Lights of a scene, and how one is chosen.
#pragma once

#include <vector>

#include <twinray/scene.h>

#include "renderer/shared.h"

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

using LocalLightSet = TWINRAY_MULTI_TYPE_SET(LocalLightsView, LOCAL_LIGHTS);

// The lights in device memory. Their number may change; who was there keeps the key.
class LightSet {
  public:
    explicit LightSet(Context& context) : set_(context, "local lights") {}

    // Replaces what was put before. Returns the keys in the order of the table.
    std::vector<SetKey> put(const LocalLights& lights);
    LocalLightsView view() const { return set_.view(); }
    std::uint64_t buffer_bytes() const { return set_.buffer_bytes(); }

  private:
    LocalLightSet set_;
    std::vector<SetKey> emitters_, punctual_;  // all that there ever were at once
};

LocalLights collect_lights(const Scene& scene);

// Whether the scene brings light to see by: a punctual light, or a surface brighter than the radiance 1 that glTF
// allows without KHR_materials_emissive_strength, which is the glow of a label or a screen rather than a lamp.
bool has_lamps(const Scene& scene);

}  // namespace twinray::path_tracer
