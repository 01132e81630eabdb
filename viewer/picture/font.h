// SPDX-License-Identifier: MIT
// Draws text into pictures, in letters of one width: ASCII; other characters are shown as question marks.
#pragma once

#include <string>
#include <string_view>

#include "viewer/picture/raster.h"

namespace twinray {

inline constexpr int text_advance = 12;  // pixels from one letter to the next
inline constexpr int text_height = 18;   // with 4 below the line; capitals are 14 high

int text_width(std::string_view text);
// Returns the text, or as much of its beginning as fits into so many pixels, with three dots.
std::string fitted(std::string_view text, int width);
// (x, y): the upper left corner.
void draw_text(Raster& raster, int x, int y, std::string_view text, Rgb color = ink);

}  // namespace twinray
