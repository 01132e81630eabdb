// The surroundings of a picture: a title above, the meaning of colours beside; and pictures of values alone: of a
// sparse matrix, of a plane.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "viewer/picture/raster.h"
#include "viewer/picture/value_scale.h"

namespace twinray {

struct LegendEntry {
    Rgb color;
    std::string name;
};

// A colour bar, named colours, or both.
struct Legend {
    std::string title;
    std::optional<ValueScale> scale;
    std::vector<LegendEntry> entries;
};

struct Page {
    std::string title, subtitle;  // one line each; the end is cut off if it does not fit
    Legend legend;
};

// The position of the picture's upper left pixel in compose()'s.
struct PagePlace {
    int x = 0, y = 0;
};
PagePlace place_in(const Page& page);
// Returns the picture with its title and its legend, on white.
Raster compose(const Raster& picture, const Page& page);

struct MatrixEntry {
    uint row, column;
    float value;
};

// The scale of a matrix of `size` rows and columns in a picture of at most `most` pixels per side.
struct MatrixLayout {
    uint entries_a_pixel = 1;  // a side: a pixel shows the mean of so many rows and columns
    uint pixels_an_entry = 1;  // a side
    uint pixels = 0;           // a side, of the whole
};
MatrixLayout matrix_layout(std::size_t size, uint most);

// Row 0 is on top, values are on a logarithmic scale, missing entries white, numbers of rows and columns at the edge.
// It uses `page`'s title, subtitle and title of the legend; it appends the meaning of a pixel to the subtitle.
Raster draw_matrix(std::size_t size, std::span<const MatrixEntry> entries, Page page);

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
