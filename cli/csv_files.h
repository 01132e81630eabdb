// SPDX-License-Identifier: MIT
// What commands read of files with a line of numbers for each thing, under a heading or none.
#pragma once

#include <twinray/analysis.h>

#include <filesystem>
#include <vector>

namespace twinray::cli {

inline constexpr std::uint64_t most_points = 1u << 28;

// Each throws Error naming the file, and the line where that is wrong.

// x,y,z: points, from each of which `origin` is subtracted.
std::vector<dvec3> read_points(const std::filesystem::path& file, const dvec3& origin);
// face,group: the group of each of `face_count` faces, once, numbered from 0 and below their count.
std::vector<uint> read_face_groups(const std::filesystem::path& file, std::size_t face_count);
// x,y,z,hours
std::vector<SunPosition> read_sun(const std::filesystem::path& file);

}  // namespace twinray::cli
