// SPDX-License-Identifier: MIT
#include "viewer/picture/page.h"

#include <algorithm>

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

}  // namespace twinray
