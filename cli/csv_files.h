// SPDX-License-Identifier: MIT
// Files with a line for each thing: what commands read of numbers, under a heading or none, and tables that they write.
#pragma once

#include <twinray/analysis.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "engine/core/error.h"

namespace twinray::cli {

inline constexpr std::uint64_t most_points = 1u << 28;

// Each throws Error naming the file, and the line where that is wrong.

// x,y,z: points, from each of which `origin` is subtracted.
std::vector<dvec3> read_points(const std::filesystem::path& file, const dvec3& origin);
// face,group: the group of each of `face_count` faces, once, numbered from 0 and below their count.
std::vector<uint> read_face_groups(const std::filesystem::path& file, std::size_t face_count);
// x,y,z,hours
std::vector<SunPosition> read_sun(const std::filesystem::path& file);

// Writes CSV, a line for each row as `print` writes it, float64 with all its digits; nothing for an empty path.
template <class Row, class Print>
void write_table(const std::filesystem::path& file, const char* header, const std::vector<Row>& rows,
                 const Print& print) {
    if (file.empty()) return;
    std::ofstream out(file);
    out.precision(17);
    out << header << '\n';
    for (const Row& row : rows) print(out, row);
    if (!out.flush()) fail("CSV file '", file.string(), "' cannot be written");
}

}  // namespace twinray::cli
