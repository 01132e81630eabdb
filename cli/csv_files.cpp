#include "cli/csv_files.h"

#include <cmath>
#include <iomanip>

#include "engine/scene/importers/words.h"

namespace twinray::cli {

std::vector<dvec3> read_points(const std::filesystem::path& file, const dvec3& origin) {
    std::vector<dvec3> points;
    read_number_lines(file, "points file", "x,y,z", [&](std::span<const double> xyz, std::size_t) {
        if (points.size() == most_points) fail("points file '", file.string(), "': it has more than ", most_points);
        points.push_back(dvec3(xyz[0] - origin.x, xyz[1] - origin.y, xyz[2] - origin.z));
    });
    return points;
}

std::vector<uint> read_face_groups(const std::filesystem::path& file, std::size_t face_count) {
    constexpr uint no_group = ~0u;
    std::vector<uint> groups(face_count, no_group);
    read_number_lines(file, "groups file", "face,group", [&](std::span<const double> line, std::size_t number) {
        const auto checked = [&](double value, const char* of) {
            if (!(value >= 0) || !(value < static_cast<double>(face_count)) || value != std::floor(value))
                fail("groups file '", file.string(), "', line ", number, ": ", of, ' ', std::setprecision(17), value,
                     "; both must be whole numbers from 0 to ", static_cast<std::int64_t>(face_count) - 1,
                     ", because the scene has that many faces");
            return static_cast<uint>(value);
        };
        const uint face = checked(line[0], "face"), group = checked(line[1], "group");
        if (groups[face] != no_group)
            fail("groups file '", file.string(), "', line ", number, ": face ", face, " occurs twice");
        groups[face] = group;
    });
    for (std::size_t face = 0; face < face_count; ++face)
        if (groups[face] == no_group) fail("groups file '", file.string(), "': face ", face, " is missing");
    return groups;
}

std::vector<SunPosition> read_sun(const std::filesystem::path& file) {
    std::vector<SunPosition> positions;
    read_number_lines(file, "sun file", "x,y,z,hours", [&](std::span<const double> n, std::size_t) {
        positions.push_back({.direction = {n[0], n[1], n[2]}, .hours = n[3]});
    });
    return positions;
}

}  // namespace twinray::cli
