// SPDX-License-Identifier: MIT
#include "tests/fuzz/scene_contract.h"

namespace twinray::fuzz {

// Told apart by their content, whatever the name.
void gltf(Input input) { load_whole_scene(file_of(input, "input.gltf")); }

}  // namespace twinray::fuzz
