// SPDX-License-Identifier: MIT
// What a report claims rests on cases: the one table of which. Unless all of them ran, a claim is not measured.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace twinray::suite {

// What cases ask of rays, and count by class.
enum class Subject : std::uint8_t {
    aimed_rays,  // hits of rays that are aimed at edges and vertices
    hits,        // hits of any rays, those included
    crossings    // how many triangles a ray crosses
};

// Ids of the catalogue's cases that ask it with their least amount, in order.
std::span<const std::string_view> cases_about(Subject subject);
bool is_about(std::string_view case_id, Subject subject);

}  // namespace twinray::suite
