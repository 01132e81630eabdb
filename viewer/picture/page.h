// SPDX-License-Identifier: MIT
// What stands around a picture: a title above, what colours mean beside.
#pragma once

#include <optional>

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
    std::string title, subtitle;  // a line each; what does not fit is cut off
    Legend legend;
};

// Where the picture's upper left pixel lies in compose()'s.
struct PagePlace {
    int x = 0, y = 0;
};
PagePlace place_in(const Page& page);
// The picture with its title and its legend, on white.
Raster compose(const Raster& picture, const Page& page);

}  // namespace twinray
