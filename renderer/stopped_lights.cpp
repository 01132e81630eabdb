// SPDX-License-Identifier: MIT
#include "renderer/stopped_lights.h"

#include "renderer/material_kinds.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::text;
namespace {

// "'sun'", "'sun' and 2 others".
std::string names_of(const std::vector<Light>& lights) {
    const std::size_t others = lights.size() - 1;
    const std::string first = text("'", lights[0].name, "'");
    return others == 0 ? first : text(first, " and ", others, others == 1 ? " other" : " others");
}

}  // namespace

std::vector<std::string> stopped_lights(const Scene& scene) {
    std::vector<std::string> sentences;
    if (scene.lights.empty()) return sentences;
    const std::vector<bool> used = used_materials(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        if (!used[i] || !may_be_other_glass(material)) continue;
        const char* why = material.thickness > 0 ? "the boundary of a volume bends it" : "rough glass scatters it";
        sentences.push_back(text("light of ", names_of(scene.lights), " cannot pass material '", material.name,
                                 "': ", why, ", and no path can reach a light without size"));
    }
    return sentences;
}

}  // namespace twinray::path_tracer
