// SPDX-License-Identifier: MIT
// What is said of one ray: by both accelerators, by the float64 reference, and on the way through the tree.
#pragma once

#include <optional>
#include <string>

#include "report/replay/replay.h"
#include "viewer/stage.h"

namespace twinray::viewer {

struct Pick {
    Ray ray{};
    Hit software{}, hardware{};
    bool has_hardware = false;
    ReferenceHit reference;
    HitClass software_class = HitClass::agree, hardware_class = HitClass::agree;
    std::optional<dvec3> point;                          // of the software's hit, in world space
    std::optional<std::size_t> face;                     // of the same, by instance, then by triangle
    std::uint64_t nodes = 0, boxes = 0, primitives = 0;  // that the ray asks the software tree for
};
Pick pick(Stage& stage, const Ray& ray);

// A line each: the ray, the hits and what they are worth, steps.
std::string text_of(const Pick& pick);
// Triangle tests and boxes on the way to what either says, in float32 and exactly.
std::string explanation_of(Stage& stage, const Pick& pick);
// For `twinray verify --replay`. `version`: of twinray.
replay::Replay replay_of(Stage& stage, const Pick& pick, const std::string& version);

}  // namespace twinray::viewer
