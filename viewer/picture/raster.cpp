// SPDX-License-Identifier: MIT
#include "viewer/picture/raster.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {

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

}  // namespace twinray
