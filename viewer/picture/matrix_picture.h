// SPDX-License-Identifier: MIT
// A sparse square matrix of values above 0 as a picture.
#pragma once

#include <span>

#include "viewer/picture/page.h"

namespace twinray {

struct MatrixEntry {
    uint row, column;
    float value;
};

// How a matrix of `size` rows and columns goes into a picture of at most `most` pixels a side.
struct MatrixLayout {
    uint entries_a_pixel = 1;  // a side: a pixel shows the mean of so many rows and columns
    uint pixels_an_entry = 1;  // a side
    uint pixels = 0;           // a side, of the whole
};
MatrixLayout matrix_layout(std::size_t size, uint most);

// Row 0 on top, values on a logarithmic scale, entries that are not there white, numbers of rows and columns at the
// edge. Of `page` title, subtitle and title of the legend count; the subtitle is completed by what a pixel is.
Raster draw_matrix(std::size_t size, std::span<const MatrixEntry> entries, Page page);

}  // namespace twinray
