// SPDX-License-Identifier: MIT
#include "tests/fuzz/scene_contract.h"

namespace twinray::fuzz {

void stl(Input input) { load_whole_scene(file_of(input, "input.stl")); }

}  // namespace twinray::fuzz
