// SPDX-License-Identifier: MIT
// Shows a sparse square matrix of values above 0 as a picture.
#pragma once

#include <span>

#include "viewer/picture/page.h"

namespace twinray {

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

}  // namespace twinray
