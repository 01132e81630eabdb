// SPDX-License-Identifier: MIT
// Changes to scenes and rays that must not change what is hit, and answers mapped back.
#pragma once

#include <functional>

#include "report/conformance/expectation.h"
#include "report/conformance/verdict.h"

namespace twinray::conformance {

// A changed scene with its rays, and how its answers map back to the original scene: ids and t. Facing, barycentrics
// and the object's ray are not mapped back.
struct Changed {
    SceneInput scene;
    std::vector<Shot> shots;
    std::function<void(Answer&)> bring_back = [](Answer&) {};
};

// Coordinates are multiples of 2^-10 of some units (draws.h), so that all of these are exact.
Changed translated(const SceneInput& scene, std::span<const Shot> shots, vec3 offset);
Changed turned(const SceneInput& scene, std::span<const Shot> shots, int axis);  // by 90 degrees
Changed scaled(const SceneInput& scene, std::span<const Shot> shots, float power_of_two);
Changed faster(const SceneInput& scene, std::span<const Shot> shots, float power_of_two);  // directions
// Triangle order[i] of the first geometry becomes triangle i.
Changed permuted(const SceneInput& scene, std::span<const Shot> shots, std::span<const uint> order);
// Splits the first geometry before triangle `at` into two geometries, or into two bottom levels in two instances.
Changed split_geometry(const SceneInput& scene, std::span<const Shot> shots, uint at);
Changed split_instance(const SceneInput& scene, std::span<const Shot> shots, uint at);
// Moves vertices by the inverse, and instances back again.
Changed by_instance(const SceneInput& scene, std::span<const Shot> shots, vec3 offset, float power_of_two);
// Returns the ray from its end at `t` back to its origin.
Shot reversed(const Shot& shot, float t);

// Compares two answers to a shot. They may name different triangles where rounding decides: at an edge, a tie, an end
// of the interval.
Finding compare_hits(const Expectation& expectation, const Shot& shot, const Answer& first, const Answer& second);
// Compares two lists of candidates in any order. A candidate that only one of them has must be uncertain.
Finding compare_candidates(const Expectation& expectation, const Shot& shot, std::span<const uint> first,
                           std::span<const uint> second);

}  // namespace twinray::conformance
