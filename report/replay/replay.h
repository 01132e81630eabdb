// SPDX-License-Identifier: MIT
// One faulty ray as a file: all that it takes to trace it again and to see what went wrong.
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

// A file for each fault, "random-SW_LEAK-1.json" of the set "random", into the folder, which is made; without
// `with_driver` only those of twinray. `common`: what all have in common, its backend that of the driver's; `reference`
// tells what is right. Returns how many files were written.
std::size_t write_faults(const std::filesystem::path& folder, const std::string& set, std::span<const Fault> faults,
                         bool with_driver, Replay common, const std::function<ReferenceHit(const Ray&)>& reference);

}  // namespace twinray::replay
