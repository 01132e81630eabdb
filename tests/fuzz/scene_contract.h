// SPDX-License-Identifier: MIT
// What whoever takes a loaded scene relies on.
#pragma once

#include "tests/fuzz/contract.h"
#include <twinray/scene.h>

namespace twinray::fuzz {

// Loads the file, and ends the process unless what load_scene() took is whole: every index has what it names, every
// array its length, and what moves can be posed.
void load_whole_scene(const std::filesystem::path& file);

}  // namespace twinray::fuzz
