#include "viewer/picture/raster.h"

#include <algorithm>
#include <array>

#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {

constexpr int glyph_width = 5, glyph_height = 9;  // two of the rows are below the line
constexpr char first_glyph = ' ', last_glyph = '~';
constexpr int glyphs_a_row = 16;

// The glyphs of ASCII from space to tilde.
constexpr std::array sheet = {
    "..... ..#.. .#.#. .#.#. ..#.. ##..# .##.. ..#.. ...#. .#... ..... ..... ..... ..... ..... ....#",
    "..... ..#.. .#.#. .#.#. .#### ##..# #..#. ..#.. ..#.. ..#.. ..#.. ..#.. ..... ..... ..... ....#",
    "..... ..#.. .#.#. ##### #.#.. ...#. #.#.. ..#.. .#... ...#. #.#.# ..#.. ..... ..... ..... ...#.",
    "..... ..#.. ..... .#.#. .###. ..#.. .#... ..... .#... ...#. .###. ##### ..... ##### ..... ..#..",
    "..... ..#.. ..... ##### ..#.# .#... #.#.# ..... .#... ...#. #.#.# ..#.. ..... ..... ..... .#...",
    "..... ..... ..... .#.#. ####. #..## #..#. ..... ..#.. ..#.. ..#.. ..#.. ..#.. ..... .##.. #....",
    "..... ..#.. ..... .#.#. ..#.. #..## .##.# ..... ...#. .#... ..... ..... ..#.. ..... .##.. #....",
    "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .#... ..... ..... .....",
    "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....",

    ".###. ..#.. .###. .###. ...#. ##### ..##. ##### .###. .###. ..... ..... ...#. ..... .#... .###.",
    "#...# .##.. #...# #...# ..##. #.... .#... ....# #...# #...# .##.. ..#.. ..#.. ..... ..#.. #...#",
    "#..## ..#.. ....# ....# .#.#. ####. #.... ...#. #...# #...# .##.. ..#.. .#... ##### ...#. ....#",
    "#.#.# ..#.. ...#. ..##. #..#. ....# ####. ..#.. .###. .#### ..... ..... #.... ..... ....# ...#.",
    "##..# ..#.. ..#.. ....# ##### ....# #...# .#... #...# ....# ..... ..... .#... ##### ...#. ..#..",
    "#...# ..#.. .#... #...# ...#. #...# #...# .#... #...# ...#. .##.. ..#.. ..#.. ..... ..#.. .....",
    ".###. .###. ##### .###. ...#. .###. .###. .#... .###. .##.. .##.. ..#.. ...#. ..... .#... ..#..",
    "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .#... ..... ..... ..... .....",
    "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....",

    ".###. .###. ####. .###. ####. ##### ##### .###. #...# .###. ..### #...# #.... #...# #...# .###.",
    "#...# #...# #...# #...# #...# #.... #.... #...# #...# ..#.. ...#. #..#. #.... ##.## ##..# #...#",
    "#.### #...# #...# #.... #...# #.... #.... #.... #...# ..#.. ...#. #.#.. #.... #.#.# ##..# #...#",
    "#.#.# ##### ####. #.... #...# ####. ####. #.### ##### ..#.. ...#. ##... #.... #.#.# #.#.# #...#",
    "#.##. #...# #...# #.... #...# #.... #.... #...# #...# ..#.. ...#. #.#.. #.... #...# #..## #...#",
    "#.... #...# #...# #...# #...# #.... #.... #...# #...# ..#.. #..#. #..#. #.... #...# #..## #...#",
    ".###. #...# ####. .###. ####. ##### #.... .###. #...# .###. .##.. #...# ##### #...# #...# .###.",
    "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....",
    "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....",

    "####. .###. ####. .#### ##### #...# #...# #...# #...# #...# ##### .###. #.... .###. ..#.. .....",
    "#...# #...# #...# #.... ..#.. #...# #...# #...# #...# #...# ....# .#... #.... ...#. .#.#. .....",
    "#...# #...# #...# #.... ..#.. #...# #...# #...# .#.#. .#.#. ...#. .#... .#... ...#. #...# .....",
    "####. #...# ####. .###. ..#.. #...# #...# #.#.# ..#.. ..#.. ..#.. .#... ..#.. ...#. ..... .....",
    "#.... #.#.# #.#.. ....# ..#.. #...# #...# #.#.# .#.#. ..#.. .#... .#... ...#. ...#. ..... .....",
    "#.... #..#. #..#. ....# ..#.. #...# .#.#. ##.## #...# ..#.. #.... .#... ....# ...#. ..... .....",
    "#.... .##.# #...# ####. ..#.. .###. ..#.. #...# #...# ..#.. ##### .###. ....# .###. ..... .....",
    "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... #####",
    "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....",

    ".#... ..... #.... ..... ....# ..... ..##. ..... #.... ..#.. ...#. #.... .##.. ..... ..... .....",
    "..#.. ..... #.... ..... ....# ..... .#... ..... #.... ..... ..... #.... ..#.. ..... ..... .....",
    "..... .###. ####. .#### .#### .###. ####. .#### ####. .##.. ..##. #..#. ..#.. ##.#. ####. .###.",
    "..... ....# #...# #.... #...# #...# .#... #...# #...# ..#.. ...#. #.#.. ..#.. #.#.# #...# #...#",
    "..... .#### #...# #.... #...# ##### .#... #...# #...# ..#.. ...#. ##... ..#.. #.#.# #...# #...#",
    "..... #...# #...# #.... #...# #.... .#... #...# #...# ..#.. ...#. #.#.. ..#.. #.#.# #...# #...#",
    "..... .#### ####. .#### .#### .###. .#... .#### #...# .###. ...#. #..#. .###. #.#.# #...# .###.",
    "..... ..... ..... ..... ..... ..... ..... ....# ..... ..... ...#. ..... ..... ..... ..... .....",
    "..... ..... ..... ..... ..... ..... ..... .###. ..... ..... .##.. ..... ..... ..... ..... .....",

    "..... ..... ..... ..... .#... ..... ..... ..... ..... ..... ..... ...#. ..#.. .#... ..... .....",
    "..... ..... ..... ..... .#... ..... ..... ..... ..... ..... ..... ..#.. ..#.. ..#.. ..... .....",
    "####. .#### #.##. .#### ####. #...# #...# #...# #...# #...# ##### ..#.. ..#.. ..#.. .#..# .....",
    "#...# #...# ##..# #.... .#... #...# #...# #.#.# .#.#. #...# ...#. .#... ..#.. ...#. #.#.# .....",
    "#...# #...# #.... .###. .#... #...# #...# #.#.# ..#.. #...# ..#.. ..#.. ..#.. ..#.. #..#. .....",
    "#...# #...# #.... ....# .#..# #...# .#.#. #.#.# .#.#. #...# .#... ..#.. ..#.. ..#.. ..... .....",
    "####. .#### #.... ####. ..##. .#### ..#.. .#.#. #...# .#### ##### ...#. ..#.. .#... ..... .....",
    "#.... ....# ..... ..... ..... ..... ..... ..... ..... ....# ..... ..... ..... ..... ..... .....",
    "#.... ....# ..... ..... ..... ..... ..... ..... ..... .###. ..... ..... ..... ..... ..... .....",
};

bool has_ink(char glyph, int x, int y) {
    if (x < 0 || y < 0 || x >= glyph_width || y >= glyph_height) return false;
    const int index = (glyph < first_glyph || glyph > last_glyph ? '?' : glyph) - first_glyph;
    const int row = index / glyphs_a_row * glyph_height + y, column = index % glyphs_a_row * (glyph_width + 1) + x;
    return sheet[static_cast<std::size_t>(row)][column] == '#';
}

// Returns one of the four pixels of (x, y) in twice the size, with diagonals rounded (Scale2x, Mazzoleni 2001): a
// corner takes the value of the two neighbours beside it if these agree and those across do not.
bool has_ink_twice(char glyph, int x, int y, int right, int down) {
    const bool here = has_ink(glyph, x, y);
    const bool beside = has_ink(glyph, x + (right ? 1 : -1), y), across = has_ink(glyph, x + (right ? -1 : 1), y);
    const bool above = has_ink(glyph, x, y + (down ? 1 : -1)), below = has_ink(glyph, x, y + (down ? -1 : 1));
    return beside == above && beside != below && above != across ? beside : here;
}

// Bytes that continue a character of UTF-8 have no glyph of their own.
bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }

}  // namespace

void blend(Rgb& under, Rgb color, float opacity) {
    under = opacity >= 1 ? color : rgb_of_linear(mix(linear_of(under), linear_of(color), opacity));
}

void fill(Raster& raster, Rect rect, Rgb color) {
    const int right = std::min(rect.x + rect.width, static_cast<int>(raster.width));
    const int bottom = std::min(rect.y + rect.height, static_cast<int>(raster.height));
    for (int y = std::max(rect.y, 0); y < bottom; ++y)
        for (int x = std::max(rect.x, 0); x < right; ++x) raster.at(static_cast<uint>(x), static_cast<uint>(y)) = color;
}

void outline(Raster& raster, Rect rect, Rgb color) {
    fill(raster, {rect.x, rect.y, rect.width, 1}, color);
    fill(raster, {rect.x, rect.y + rect.height - 1, rect.width, 1}, color);
    fill(raster, {rect.x, rect.y, 1, rect.height}, color);
    fill(raster, {rect.x + rect.width - 1, rect.y, 1, rect.height}, color);
}

void paste(Raster& raster, const Raster& part, int x, int y) {
    for (uint row = 0; row < part.height; ++row)
        for (uint column = 0; column < part.width; ++column)
            fill(raster, {x + static_cast<int>(column), y + static_cast<int>(row), 1, 1}, part.at(column, row));
}

int text_width(std::string_view text) {
    return text_advance * static_cast<int>(std::count_if(text.begin(), text.end(), begins_character));
}

std::string fitted(std::string_view text, int width) {
    if (text_width(text) <= width) return std::string(text);
    std::string cut;
    int left = width / text_advance - 3;
    for (const char c : text) {
        if (begins_character(c) && left-- <= 0) break;
        cut += c;
    }
    return cut + "...";
}

void draw_text(Raster& raster, int x, int y, std::string_view text, Rgb color) {
    for (const char c : text) {
        if (!begins_character(c)) continue;
        for (int row = 0; row < 2 * glyph_height; ++row)
            for (int column = 0; column < 2 * glyph_width; ++column)
                if (has_ink_twice(c, column / 2, row / 2, column % 2, row % 2))
                    fill(raster, {x + column, y + row, 1, 1}, color);
        x += text_advance;
    }
}

}  // namespace twinray
