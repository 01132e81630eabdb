// CSV files with a line for each thing: numbers that commands read, with or without a heading, and tables they write.
#pragma once

#include <twinray/analysis.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "engine/core/error.h"

namespace twinray::cli {

inline constexpr std::uint64_t most_points = 1u << 28;

// Each of these throws Error naming the file, and the line if that is wrong.

// Reads points as x,y,z and subtracts `origin` from each.
std::vector<dvec3> read_points(const std::filesystem::path& file, const dvec3& origin);
// Reads face,group: the group of each of `face_count` faces, once, numbered from 0 and below their count.
std::vector<uint> read_face_groups(const std::filesystem::path& file, std::size_t face_count);
// Reads x,y,z,hours.
std::vector<SunPosition> read_sun(const std::filesystem::path& file);

// Writes CSV, a line for each row as `print` writes it, float64 with all its digits; does nothing for an empty path.
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
