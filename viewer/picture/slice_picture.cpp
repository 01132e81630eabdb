// SPDX-License-Identifier: MIT
#include "viewer/picture/slice_picture.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"

namespace twinray {
namespace {

struct Axes {
    int right, up, normal;
    double up_sign;
};

Axes axes_of(char axis) {
    if (axis == 'x') return {2, 1, 0, 1};
    if (axis == 'y') return {0, 2, 1, -1};
    return {0, 1, 2, 1};
}

// Draws lines of equal value, where a multiple of `level` lies between neighbours; the surface is black.
void draw_levels(Raster& picture, std::span<const double> values, double level) {
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

Slice slice_of(const SliceDesc& desc, const dvec3& lo, const dvec3& size) {
    const auto [right, up, normal, up_sign] = axes_of(desc.axis);
    const double step = std::max(size[right], size[up]) / desc.width;  // between points
    if (!(step > 0)) fail("slice: the scene has no extent across ", desc.axis);
    Slice slice{.columns = std::max(1u, static_cast<uint>(std::lround(size[right] / step))),
                .rows = std::max(1u, static_cast<uint>(std::lround(size[up] / step))),
                .points = {}};
    dvec3 point;
    point[normal] = desc.at.value_or(lo[normal] + size[normal] / 2);
    const double middle = lo[up] + size[up] / 2;
    for (uint y = 0; y < slice.rows; ++y)
        for (uint x = 0; x < slice.columns; ++x) {
            point[right] = lo[right] + (x + 0.5) * step;
            point[up] = middle + up_sign * (slice.rows / 2.0 - y - 0.5) * step;
            slice.points.push_back(point);
        }
    return slice;
}

Raster draw_slice(const Slice& slice, std::span<const double> values, const ValueScale& scale) {
    Raster picture(slice.columns, slice.rows);
    std::transform(values.begin(), values.end(), picture.pixels.begin(),
                   [&](double value) { return scale.color(value); });
    draw_levels(picture, values, (scale.hi() - scale.lo()) / 20);
    return picture;
}

}  // namespace twinray
