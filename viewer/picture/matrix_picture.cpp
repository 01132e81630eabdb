// SPDX-License-Identifier: MIT
#include "viewer/picture/matrix_picture.h"

#include <algorithm>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr uint most_pixels = 900;
constexpr std::size_t most_ticks = 8;
constexpr int axis_tick = 6, label_gap = 6;

// Returns means over the entries of a pixel, row 0 first; 0 if there are none.
std::vector<double> means_of(std::size_t size, std::span<const MatrixEntry> entries, uint entries_a_pixel) {
    const std::size_t side = (size + entries_a_pixel - 1) / entries_a_pixel;
    const auto extent = [&](std::size_t place) {
        return static_cast<double>(std::min<std::size_t>(entries_a_pixel, size - place * entries_a_pixel));
    };
    std::vector<double> means(side * side);
    for (const MatrixEntry& entry : entries) {
        const std::size_t row = entry.row / entries_a_pixel, column = entry.column / entries_a_pixel;
        means[row * side + column] += static_cast<double>(entry.value) / (extent(row) * extent(column));
    }
    return means;
}

Raster colored(const std::vector<double>& means, const ValueScale& scale, const MatrixLayout& layout) {
    Raster raster(layout.pixels, layout.pixels);
    const std::size_t side = layout.pixels / layout.pixels_an_entry;
    for (uint y = 0; y < raster.height; ++y)
        for (uint x = 0; x < raster.width; ++x)
            if (const double mean = means[y / layout.pixels_an_entry * side + x / layout.pixels_an_entry]; mean > 0)
                raster.at(x, y) = scale.color(mean);
    return raster;
}

// Adds numbers of rows to the left, of columns below.
Raster with_numbers(const Raster& matrix, std::size_t size, const MatrixLayout& layout) {
    const std::vector<Tick> ticks = ValueScale::linear(0, static_cast<double>(size)).ticks(most_ticks);
    const int side = static_cast<int>(layout.pixels);
    const int left = text_width(std::to_string(size)) + axis_tick + label_gap,
              below = axis_tick + label_gap + text_height;
    Raster raster(static_cast<uint>(left + side + 1), static_cast<uint>(1 + side + below));
    paste(raster, matrix, left, 1);
    outline(raster, {left - 1, 0, side + 2, side + 2}, ink);
    for (const Tick& tick : ticks) {
        const int offset = static_cast<int>(std::lround(tick.position * side)), width = text_width(tick.label);
        fill(raster, {left - 1 - axis_tick, 1 + offset, axis_tick, 1}, ink);
        draw_text(raster, left - axis_tick - label_gap - width, std::clamp(offset - 6, 0, side - 14), tick.label);
        fill(raster, {left + offset, side + 1, 1, axis_tick}, ink);
        draw_text(raster, std::clamp(left + offset - width / 2, 0, left + side - width), side + axis_tick + label_gap,
                  tick.label);
    }
    return raster;
}

std::string pixel_text(const MatrixLayout& layout) {
    if (layout.entries_a_pixel == 1) return "";
    return text(", each pixel is the mean of ", layout.entries_a_pixel, " x ", layout.entries_a_pixel, " entries");
}

}  // namespace

MatrixLayout matrix_layout(std::size_t size, uint most) {
    const std::size_t n = std::max<std::size_t>(size, 1);
    MatrixLayout layout;
    layout.entries_a_pixel = static_cast<uint>((n + most - 1) / most);
    layout.pixels_an_entry = static_cast<uint>(std::max<std::size_t>(most / n, 1));
    layout.pixels =
        static_cast<uint>((n + layout.entries_a_pixel - 1) / layout.entries_a_pixel) * layout.pixels_an_entry;
    return layout;
}

Raster draw_matrix(std::size_t size, std::span<const MatrixEntry> entries, Page page) {
    const std::size_t n = std::max<std::size_t>(size, 1);
    const MatrixLayout layout = matrix_layout(n, most_pixels);
    const std::vector<double> means = means_of(n, entries, layout.entries_a_pixel);
    page.legend.scale = ValueScale::logarithmic_for(means);
    page.legend.entries.push_back({paper, "none"});
    page.subtitle += pixel_text(layout);
    return compose(with_numbers(colored(means, *page.legend.scale, layout), n, layout), page);
}

}  // namespace twinray
