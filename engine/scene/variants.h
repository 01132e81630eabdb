// SPDX-License-Identifier: MIT
#pragma once

#include "engine/scene/scene.h"

namespace twinray {

// Gives the scene's meshes the materials of one of its variants. Throws Error naming those it has.
void apply_variant(Scene& scene, const std::string& name);

}  // namespace twinray
