// SPDX-License-Identifier: MIT
// The points about which `twinray distance` asks: of a file, at random, or of a grid.
#pragma once

#include <filesystem>
#include <vector>

#include <twinray/scene.h>

#include "cli/command/command.h"

namespace twinray::cli {

// Of the scene, grown by a tenth of its largest side on all sides. Throws Error where there is no triangle.
struct QueryBox {
    dvec3 lo, size;
};
QueryBox query_box(const Scene& scene);

struct QueryPointOptions {
    std::filesystem::path file;
    std::uint64_t random = 0;
    std::uint64_t grid = 0;  // points along each side

    bool is_asked_for() const { return !file.empty() || random > 0 || grid > 0; }
    // The last two in query_box(): of a grid, the centres of its cells, x fastest. None if nothing was asked for.
    // Throws Error naming the file and the line.
    std::vector<dvec3> make(const Scene& scene, std::uint64_t seed) const;
};
// --points, --random, --grid: at most one of them.
std::vector<Option> query_point_options(QueryPointOptions& options);

}  // namespace twinray::cli
