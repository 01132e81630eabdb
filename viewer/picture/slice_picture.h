// SPDX-License-Identifier: MIT
// Values in a plane as a picture.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "viewer/picture/raster.h"
#include "viewer/picture/value_scale.h"

namespace twinray {

struct SliceDesc {
    char axis = 'z';           // the axis perpendicular to the plane: x, y or z
    std::optional<double> at;  // the plane's coordinate on it; none: the middle of the box
    uint width = 480;          // pixels of the larger side, a point each
};

// A rectangle of points, row 0 on top, as seen from the front (z), from the right (x), or from above with -z at the top
// (y).
struct Slice {
    uint columns = 0, rows = 0;
    std::vector<dvec3> points;
};
// Cuts through the box of this size from `lo`. Throws Error if it has no extent perpendicular to the axis.
Slice slice_of(const SliceDesc& desc, const dvec3& lo, const dvec3& size);

// Draws a value for each point, 20 lines of equal value over the scale, and a black one where values change their sign.
Raster draw_slice(const Slice& slice, std::span<const double> values, const ValueScale& scale);

}  // namespace twinray
