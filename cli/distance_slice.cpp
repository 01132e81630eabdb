// SPDX-License-Identifier: MIT
#include "cli/distance_slice.h"

#include <algorithm>
#include <cmath>

#include <twinray/scene.h>

#include "cli/command/values.h"
#include "cli/places.h"
#include "cli/query_points.h"
#include "engine/core/error.h"
#include "validation/picture/page.h"

namespace twinray::cli {
namespace {

// A rectangle of points, row 0 on top.
struct Slice {
    uint columns, rows;
    double step;  // between points
    std::vector<dvec3> points;
};

struct Axes {
    int right, up, normal;
    double up_sign;
};

// As one looks at it: from the front, from the right, or from above with -z at the top.
Axes axes_of(char axis) {
    if (axis == 'x') return {2, 1, 0, 1};
    if (axis == 'y') return {0, 2, 1, -1};
    return {0, 1, 2, 1};
}

Slice slice_of(const SliceOptions& options, const Scene& scene) {
    const QueryBox box = query_box(scene);
    const auto [right, up, normal, up_sign] = axes_of(options.axis);
    Slice slice;
    slice.step = std::max(box.size[right], box.size[up]) / options.width;
    if (!(slice.step > 0)) fail("--slice: the scene has no extent across ", options.axis);
    slice.columns = std::max(1u, static_cast<uint>(std::lround(box.size[right] / slice.step)));
    slice.rows = std::max(1u, static_cast<uint>(std::lround(box.size[up] / slice.step)));
    dvec3 point;
    point[normal] = options.at ? *options.at - scene.origin[normal] : box.lo[normal] + box.size[normal] / 2;
    const double middle = box.lo[up] + box.size[up] / 2;
    for (uint y = 0; y < slice.rows; ++y)
        for (uint x = 0; x < slice.columns; ++x) {
            point[right] = box.lo[right] + (x + 0.5) * slice.step;
            point[up] = middle + up_sign * (slice.rows / 2.0 - y - 0.5) * slice.step;
            slice.points.push_back(point);
        }
    return slice;
}

// Lines of equal distance, where a multiple of `level` lies between neighbours; the surface is black.
void draw_levels(Raster& picture, const std::vector<double>& values, double level) {
    const auto value = [&](uint x, uint y) { return values[std::size_t{y} * picture.width + x]; };
    const auto differs = [&](double a, double b) { return std::floor(a / level) != std::floor(b / level); };
    for (uint y = 0; y + 1 < picture.height; ++y)
        for (uint x = 0; x + 1 < picture.width; ++x) {
            const double here = value(x, y), right = value(x + 1, y), below = value(x, y + 1);
            if (here * right < 0 || here * below < 0)
                picture.at(x, y) = ink;
            else if (differs(here, right) || differs(here, below))
                blend(picture.at(x, y), ink, 0.25f);
        }
}

}  // namespace

Section slice_options(SliceOptions& options) {
    const Names<char> axes = {{"x", 'x'}, {"y", 'y'}, {"z", 'z'}};
    return {"Slice",
            {{.name = "--slice",
              .value = file(options.file, {".png"}),
              .help = "written: distances in a plane through the scene"},
             {.name = "--slice-axis",
              .value = choice(options.axis, axes),
              .help = "the axis that the plane is perpendicular to",
              .needs = {"--slice"}},
             {.name = "--slice-at",
              .value = number(options.at),
              .help = "the plane's place along the axis; the middle of the scene if not given",
              .needs = {"--slice"}},
             {.name = "--slice-size",
              .value = number(options.width, {16, 4096}),
              .help = "pixels of the larger side",
              .needs = {"--slice"}}}};
}

void write_slice(const SliceOptions& options, const Scene& scene, PointQuery& query, bool is_signed,
                 const std::string& title) {
    const Slice slice = slice_of(options, scene);
    std::vector<double> values;
    if (is_signed)
        values = query.signed_distances(slice.points);
    else
        for (const ClosestPoint& found : query.closest(slice.points)) values.push_back(found.distance);
    const ValueScale scale = ValueScale::linear_for(values);
    Raster picture(slice.columns, slice.rows);
    std::transform(values.begin(), values.end(), picture.pixels.begin(),
                   [&](double value) { return scale.color(value); });
    draw_levels(picture, values, (scale.hi() - scale.lo()) / 20);
    const int normal = axes_of(options.axis).normal;
    const std::string at = place_text(slice.points.front()[normal], scene.origin[normal]);
    const Raster page =
        compose(picture, {.title = title,
                          .subtitle = text("plane ", options.axis, " = ", at),
                          .legend = {.title = is_signed ? "signed" : "distance", .scale = scale, .entries = {}}});
    write_png(options.file, page.width, page.height, page.pixels);
}

}  // namespace twinray::cli
