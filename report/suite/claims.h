// SPDX-License-Identifier: MIT
// The one table of the cases on which each claim of a report rests. A claim is measured only if all of them ran.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace twinray::suite {

// A question that cases ask of rays. The answers are counted by class.
enum class Subject : std::uint8_t {
    aimed_rays,  // hits of rays that are aimed at edges and vertices
    hits,        // hits of any rays, including aimed ones
    crossings    // how many triangles a ray crosses
};

// Returns the ids of the catalogue's cases that ask it with their least amount, in order.
std::span<const std::string_view> cases_about(Subject subject);
bool is_about(std::string_view case_id, Subject subject);

}  // namespace twinray::suite
