// Pictures in memory, and drawing in them: rectangles, other pictures, text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <twinray/scene.h>

namespace twinray {

inline constexpr Rgb paper = {255, 255, 255}, ink = {30, 30, 30}, faint_ink = {110, 110, 110};

// Row 0 is on top. Drawings are clipped to it.
struct Raster {
    uint width = 0, height = 0;
    std::vector<Rgb> pixels;

    Raster(uint columns, uint rows, Rgb color = paper)
        : width(columns), height(rows), pixels(std::size_t{columns} * rows, color) {}

    Rgb& at(uint x, uint y) { return pixels[std::size_t{y} * width + x]; }
    Rgb at(uint x, uint y) const { return pixels[std::size_t{y} * width + x]; }
};

struct Rect {
    int x = 0, y = 0;  // of the upper left pixel
    int width = 0, height = 0;
};

// Mixes `color` over the present one, in linear light.
void blend(Rgb& under, Rgb color, float opacity);
void fill(Raster& raster, Rect rect, Rgb color);
// Draws it one pixel wide, inside the rectangle.
void outline(Raster& raster, Rect rect, Rgb color);
// Puts the upper left corner of `part` at (x, y).
void paste(Raster& raster, const Raster& part, int x, int y);

// Text is in letters of one width: ASCII; other characters are shown as question marks.
inline constexpr int text_advance = 12;  // pixels from one letter to the next
inline constexpr int text_height = 18;   // with 4 below the line; capitals are 14 high

int text_width(std::string_view text);
// Returns the text, or as much of its beginning as fits into so many pixels, with three dots.
std::string fitted(std::string_view text, int width);
// (x, y): the upper left corner.
void draw_text(Raster& raster, int x, int y, std::string_view text, Rgb color = ink);

}  // namespace twinray
