// SPDX-License-Identifier: MIT
#include "cli/csv_files.h"
#include "engine/scene/ray_file.h"
#include "tests/fuzz/contract.h"

namespace twinray::fuzz {

void csv(Input input) {
    constexpr std::size_t face_count = 12;
    const std::filesystem::path file = file_of(input, "input.csv");
    is_taken([&] { read_rays(file, dvec3(1)); });
    is_taken([&] { cli::read_points(file, dvec3(1)); });
    is_taken([&] { cli::read_sun(file); });
    is_taken([&] {
        const std::vector<uint> groups = cli::read_face_groups(file, face_count);
        require(groups.size() == face_count, "each face has a group");
        for (const uint group : groups) require(group < face_count, "a group has a number within that of the faces");
    });
}

}  // namespace twinray::fuzz
