// SPDX-License-Identifier: MIT
#include "cli/face_groups.h"

#include <cmath>
#include <iomanip>

#include "cli/command/values.h"
#include "engine/scene/number_lines.h"
#include "engine/core/error.h"

namespace twinray::cli {
namespace {

constexpr uint no_group = ~0u;

std::vector<uint> read_face_groups(const std::filesystem::path& file, std::size_t face_count) {
    std::vector<uint> groups(face_count, no_group);
    read_number_lines(file, "groups file", "face,group", [&](std::span<const double> line, std::size_t number) {
        const auto checked = [&](double value, const char* of) {
            if (!(value >= 0) || !(value < static_cast<double>(face_count)) || value != std::floor(value))
                fail("groups file '", file.string(), "', line ", number, ": ", of, ' ', std::setprecision(17), value,
                     "; both are whole numbers from 0 to ", static_cast<std::int64_t>(face_count) - 1,
                     ", as there are so many faces");
            return static_cast<uint>(value);
        };
        const uint face = checked(line[0], "face"), group = checked(line[1], "group");
        if (groups[face] != no_group)
            fail("groups file '", file.string(), "', line ", number, ": face ", face, " is there twice");
        groups[face] = group;
    });
    for (std::size_t face = 0; face < face_count; ++face)
        if (groups[face] == no_group) fail("groups file '", file.string(), "': face ", face, " is missing");
    return groups;
}

}  // namespace

void FaceGroupOptions::set_groups(Faces& faces) const {
    if (by == FaceGrouping::custom) faces.set_custom_groups(read_face_groups(file, faces.count()));
}

std::vector<Option> face_group_options(FaceGroupOptions& options, const std::string& of_what,
                                       const std::vector<std::string>& needs) {
    Names<FaceGrouping> groupings;
    for (const FaceGrouping by :
         {FaceGrouping::face, FaceGrouping::mesh, FaceGrouping::instance, FaceGrouping::material})
        groupings.emplace_back(name_of(by), by);
    Value groups = cli::file(options.file);
    groups.store = [store = groups.store, &options](std::span<const std::string> words) {
        options.by = FaceGrouping::custom;
        return store(words);
    };
    return {{.name = "--by", .value = choice(options.by, groupings), .help = of_what, .needs = needs},
            {.name = "--groups",
             .value = groups,
             .help = of_what + ", told by a CSV of face,group: each face once, groups numbered from 0",
             .needs = needs,
             .excludes = {"--by"}}};
}

}  // namespace twinray::cli
