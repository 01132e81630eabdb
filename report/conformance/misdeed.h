// SPDX-License-Identifier: MIT
// A driver that is wrong on purpose: the negative controls of the suite. A control spoils the data on its way to the
// driver, or the answers on their way back, so that it runs on every driver.
#pragma once

#include <string_view>

#include "report/conformance/query.h"
#include "report/conformance/scene_input.h"

namespace twinray::conformance {

enum class Misdeed : std::uint8_t {
    none,
    forgets_later_half,  // of the primitives of each geometry, at a build
    forgets_geometry_flags,
    forgets_transforms,  // of instances and geometries
    forgets_instance_masks,
    forgets_instance_flags,
    forgets_instance_ids,  // custom indices and record offsets
    forgets_updates,
    copies_in_part,  // copies and deserialised structures lack the later half
    forgets_ray_flags,
    forgets_ray_masks,
    forgets_refusals,
    forgets_limits,      // t_min and t_max
    moves_boxes,         // generates intersections elsewhere
    loses_candidates,    // does not report the last
    doubles_candidates,  // reports the last twice
    leaks,               // every eighth hit
    wavers,              // t and uv differ in every second trace
    garbles_headers,     // of serialised structures
    takes_any_file,
};
inline constexpr std::size_t misdeed_count = 20;
std::string_view name_of(Misdeed misdeed);  // "a driver that forgets updates"

void spoil(Misdeed misdeed, BottomInput& input);
void spoil(Misdeed misdeed, TopInput& input);
void spoil(Misdeed misdeed, std::vector<Shot>& shots);
// `turn`: the number of traces before this one.
void spoil(Misdeed misdeed, Traced& traced, std::size_t turn);

// Removes the part that an incomplete copy lacks.
void shorten(BottomInput& input);
void shorten(TopInput& input);

}  // namespace twinray::conformance
