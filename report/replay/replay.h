// SPDX-License-Identifier: MIT
// One faulty ray as a file: all that it takes to trace it again and to see what went wrong.
#pragma once

#include <filesystem>
#include <string>

#include "engine/core/ray.h"
#include "validation/reference/reference_scene.h"

namespace twinray::replay {

struct Replay {
    std::filesystem::path scene;  // a file for load_scene(); in a replay file, relative to that file's folder
    std::string scene_hash;       // hash_of() the scene, as it was
    std::string backend;          // "sw", "hw", "hw-pipeline"
    std::string level;            // "watertight", ...
    std::string kind;             // class of the answer: "HW_LEAK"
    Ray ray{};
    Hit answer{};
    ReferenceHit reference;
    std::string device, driver, twinray;  // who answered
};

// JSON; floats are hexadecimal words, so that none is rounded. Throws Error naming the file and what is wrong with it.
void write(const std::filesystem::path& file, const Replay& replay);
Replay read(const std::filesystem::path& file);

}  // namespace twinray::replay
