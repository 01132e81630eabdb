// SPDX-License-Identifier: MIT
// One faulty ray as a file, with all that is needed to trace it again and to see what went wrong.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "engine/core/ray.h"
#include "validation/reference/reference_scene.h"
#include "validation/verify/comparison.h"

namespace twinray::replay {

struct Replay {
    std::filesystem::path scene;  // a file for load_scene(); in a replay file, relative to that file's folder
    std::string scene_hash;       // hash_of() the traced scene
    std::string backend;          // "sw", "hw", "hw-pipeline"
    std::string level;            // "watertight", ...
    std::string kind;             // class of the answer: "HW_LEAK"
    Ray ray{};
    Hit answer{};
    ReferenceHit reference;
    std::string device, driver, twinray;  // of the answer
};

// Write and read JSON with floats as hexadecimal words, so that none is rounded. Throw Error naming the file and what
// is wrong with it.
void write(const std::filesystem::path& file, const Replay& replay);
Replay read(const std::filesystem::path& file);

// Writes a file for each fault, "random-SW_LEAK-1.json" of the set "random", into the folder, which it makes; without
// `with_driver` only faults of twinray. `common`: what all have in common, with the driver's backend; `reference`
// returns what is right. Returns how many files were written.
std::size_t write_faults(const std::filesystem::path& folder, const std::string& set, std::span<const Fault> faults,
                         bool with_driver, Replay common, const std::function<ReferenceHit(const Ray&)>& reference);

}  // namespace twinray::replay
