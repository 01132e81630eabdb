// SPDX-License-Identifier: MIT
// The verdict on a driver's answer to a shot.
#pragma once

#include <string_view>

#include "report/conformance/expectation.h"

namespace twinray::conformance {

enum class Finding : std::uint8_t {
    agrees,
    rounding,     // an edge, a tie, a limit: accepted, as float32 may decide either way
    lost,         // a miss where something is surely hit
    lost_nearer,  // a hit farther than one that is certain
    false_hit,    // of something that the ray does not meet, or may not by flags and masks
    wrong_t,
    outside_limits,  // a t that the interval excludes
    wrong_ids,       // custom index, record offset, instance, geometry or primitive
    wrong_facing,
    wrong_uv,
    wrong_transform,  // the object's ray, or the map of the instance
    not_offered,      // a candidate that is certain
    offered_again,    // though its geometry allows one
    offered_falsely,
    wrong_opacity,  // of a box
    leak,           // out of a closed mesh, or through a shared edge
    double_hit,     // of a shared edge
    differs,        // from another answer that must be the same
    broken,         // a fault that is not about a ray
};
inline constexpr std::size_t finding_count = 19;
std::string_view name_of(Finding finding);  // "AGREE", "LOST", ...
constexpr bool is_fault(Finding finding) { return finding > Finding::rounding; }

// Judges the committed hit of a ray with the shot's refusals. Boxes are met at the shot's box_t.
Finding judge_hit(const Expectation& expectation, const Shot& shot, const Answer& answer);

// Judges the candidates of a ray that refuses all of them.
Finding judge_candidates(const Expectation& expectation, const Shot& shot, const Answer& answer,
                         std::span<const uint> offered);

}  // namespace twinray::conformance
