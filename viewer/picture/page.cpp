#include "viewer/picture/page.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr int margin = 18, gap = 8, line = text_height + 6;
constexpr int bar_width = 28, tick_length = 6, swatch = 18;
constexpr int pixels_a_tick = 45;
constexpr int shortest_bar = 60, longest_bar = 600;

std::size_t tick_count(int height) { return static_cast<std::size_t>(std::max(height / pixels_a_tick, 2)); }

int title_height(const Legend& legend) { return legend.title.empty() ? 0 : line + gap; }
int entries_height(const Legend& legend) { return static_cast<int>(legend.entries.size()) * line; }

// These return the heights of a legend's colour bar and of the whole legend, beside a picture of this height.
int bar_height(const Legend& legend, int height) {
    return std::clamp(height - title_height(legend) - 2 * gap - entries_height(legend), shortest_bar, longest_bar);
}
int legend_height(const Legend& legend, int height) {
    return title_height(legend) + (legend.scale ? bar_height(legend, height) + 2 * gap : 0) + entries_height(legend);
}

int legend_width(const Legend& legend, int height) {
    int width = text_width(legend.title);
    if (legend.scale)
        for (const Tick& tick : legend.scale->ticks(tick_count(bar_height(legend, height))))
            width = std::max(width, bar_width + tick_length + gap + text_width(tick.label));
    for (const LegendEntry& entry : legend.entries) width = std::max(width, swatch + gap + text_width(entry.name));
    return width;
}

void draw_bar(Raster& raster, const ValueScale& scale, Rect bar) {
    for (int row = 0; row < bar.height; ++row) {
        const double position = 1 - static_cast<double>(row) / (bar.height - 1);
        fill(raster, {bar.x, bar.y + row, bar.width, 1}, scale.color(scale.value_at(position)));
    }
    outline(raster, {bar.x - 1, bar.y - 1, bar.width + 2, bar.height + 2}, ink);
    for (const Tick& tick : scale.ticks(tick_count(bar.height))) {
        const int y = bar.y + static_cast<int>(std::lround((1 - tick.position) * (bar.height - 1)));
        fill(raster, {bar.x + bar.width, y, tick_length, 1}, ink);
        draw_text(raster, bar.x + bar.width + tick_length + gap, y - 7, tick.label);
    }
}

void draw_legend(Raster& raster, const Legend& legend, int x, int y, int height) {
    if (!legend.title.empty()) {
        draw_text(raster, x, y, legend.title);
        y += title_height(legend);
    }
    if (legend.scale) {
        const int bar = bar_height(legend, height);
        draw_bar(raster, *legend.scale, {x + 1, y, bar_width, bar});
        y += bar + 2 * gap;
    }
    for (const LegendEntry& entry : legend.entries) {
        fill(raster, {x, y - 2, swatch, swatch}, entry.color);
        outline(raster, {x, y - 2, swatch, swatch}, ink);
        draw_text(raster, x + swatch + gap, y, entry.name);
        y += line;
    }
}

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

PagePlace place_in(const Page& page) {
    return {margin, margin + (page.title.empty() ? 0 : line) + (page.subtitle.empty() ? 0 : line)};
}

Raster compose(const Raster& picture, const Page& page) {
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    const int beside = legend_width(page.legend, height);
    const int top = place_in(page).y;
    Raster raster(static_cast<uint>(width + 3 * margin + beside),
                  static_cast<uint>(top + std::max(height, legend_height(page.legend, height)) + margin));
    int y = margin - 4;
    for (const auto& [text, color] : {std::pair(page.title, ink), std::pair(page.subtitle, faint_ink)}) {
        draw_text(raster, margin, y, fitted(text, static_cast<int>(raster.width) - 2 * margin), color);
        y += text.empty() ? 0 : line;
    }
    paste(raster, picture, margin, top);
    draw_legend(raster, page.legend, width + 2 * margin, top + 2, height);
    return raster;
}

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
