// SPDX-License-Identifier: MIT
#include "cli/distance_slice.h"

#include <algorithm>
#include <cmath>

#include <twinray/scene.h>

#include "cli/command/values.h"
#include "cli/coordinates.h"
#include "cli/query_points.h"
#include "engine/core/error.h"
#include "viewer/picture/page.h"

namespace twinray::cli {

Section slice_options(SliceOptions& options) {
    const Names<char> axes = {{"x", 'x'}, {"y", 'y'}, {"z", 'z'}};
    return {"Slice",
            {{.name = "--slice",
              .value = file(options.file, {".png"}),
              .help = "written: distances in a plane through the scene"},
             {.name = "--slice-axis",
              .value = choice(options.desc.axis, axes),
              .help = "the axis that the plane is perpendicular to",
              .needs = {"--slice"}},
             {.name = "--slice-at",
              .value = number(options.desc.at),
              .help = "where on that axis the plane is; the middle of the scene if not given",
              .needs = {"--slice"}},
             {.name = "--slice-size",
              .value = number(options.desc.width, {16, 4096}),
              .help = "pixels of the larger side",
              .needs = {"--slice"}}}};
}

void write_slice(const SliceOptions& options, const Scene& scene, PointQuery& query, bool is_signed,
                 const std::string& title) {
    const QueryBox box = query_box(scene);
    const int normal = options.desc.axis - 'x';
    SliceDesc desc = options.desc;
    if (desc.at) *desc.at -= scene.origin[normal];
    const Slice slice = slice_of(desc, box.lo, box.size);
    std::vector<double> values;
    if (is_signed)
        values = query.signed_distances(slice.points);
    else
        for (const ClosestPoint& found : query.closest(slice.points)) values.push_back(found.distance);
    const ValueScale scale = ValueScale::linear_for(values);
    const std::string at = coordinate_text(slice.points.front()[normal], scene.origin[normal]);
    const Raster page =
        compose(draw_slice(slice, values, scale),
                {.title = title,
                 .subtitle = text("plane ", desc.axis, " = ", at),
                 .legend = {.title = is_signed ? "signed" : "distance", .scale = scale, .entries = {}}});
    write_png(options.file, page.width, page.height, page.pixels);
}

}  // namespace twinray::cli
