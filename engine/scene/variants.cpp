// SPDX-License-Identifier: MIT
#include <twinray/scene.h>

#include <algorithm>

#include "engine/core/error.h"

namespace twinray {

void apply_variant(Scene& scene, const std::string& name) {
    const auto variant = std::ranges::find(scene.variants, name, &MaterialVariant::name);
    if (variant == scene.variants.end()) {
        std::string names;
        for (const MaterialVariant& other : scene.variants) names += (names.empty() ? "'" : ", '") + other.name + "'";
        fail("variant '", name, "' does not exist; the scene has ", names.empty() ? "none" : names);
    }
    for (const MaterialVariant::Part& part : variant->parts) scene.meshes[part.mesh].materials = part.materials;
}

}  // namespace twinray
