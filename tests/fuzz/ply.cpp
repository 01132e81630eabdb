// SPDX-License-Identifier: MIT
#include "tests/fuzz/scene_contract.h"

namespace twinray::fuzz {

void ply(Input input) { load_whole_scene(file_of(input, "input.ply")); }

}  // namespace twinray::fuzz
