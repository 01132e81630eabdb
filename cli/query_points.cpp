// SPDX-License-Identifier: MIT
#include "cli/query_points.h"

#include <algorithm>
#include <random>

#include "cli/command/values.h"
#include "cli/csv_files.h"
#include "engine/core/error.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::cli {
namespace {

constexpr std::uint64_t most_cells = 640;

}  // namespace

QueryBox query_box(const Scene& scene) {
    const Bounds bounds = bounds_of(scene);
    if (bounds.is_empty()) fail("distance: the scene has no triangle around which points could be");
    const dvec3 lo(bounds.lo), hi(bounds.hi), size = hi - lo;
    const double margin = 0.1 * std::max({size.x, size.y, size.z});
    return {lo - margin, size + 2 * margin};
}

std::vector<dvec3> QueryPointOptions::make(const Scene& scene, std::uint64_t seed) const {
    if (!file.empty()) return read_points(file, scene.origin);
    if (random == 0 && grid == 0) return {};
    const QueryBox box = query_box(scene);
    std::vector<dvec3> points;
    if (random > 0) {
        std::mt19937_64 generator(seed);
        const auto unit = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
        for (std::uint64_t i = 0; i < random; ++i) {
            const double x = unit(), y = unit();
            points.push_back(box.lo + box.size * dvec3(x, y, unit()));
        }
        return points;
    }
    const dvec3 cell = box.size / static_cast<double>(grid);
    for (std::uint64_t i = 0; i < grid * grid * grid; ++i) {
        const dvec3 index(static_cast<double>(i % grid), static_cast<double>(i / grid % grid),
                          static_cast<double>(i / (grid * grid)));
        points.push_back(box.lo + cell * (index + 0.5));
    }
    return points;
}

std::vector<Option> query_point_options(QueryPointOptions& options) {
    return {{.name = "--points", .value = cli::file(options.file), .help = "points from a file of x,y,z lines"},
            {.name = "--random",
             .value = number(options.random, {1, most_points}),
             .help = "so many, in the box of the scene and a tenth around it"},
            {.name = "--grid",
             .value = number(options.grid, {1, most_cells}),
             .help = "the centres of N x N x N cells of that box, x fastest"}};
}

}  // namespace twinray::cli
