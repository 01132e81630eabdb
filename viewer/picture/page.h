// SPDX-License-Identifier: MIT
// The surroundings of a picture: a title above, the meaning of colours beside.
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
    std::string title, subtitle;  // one line each; the end is cut off if it does not fit
    Legend legend;
};

// The position of the picture's upper left pixel in compose()'s.
struct PagePlace {
    int x = 0, y = 0;
};
PagePlace place_in(const Page& page);
// Returns the picture with its title and its legend, on white.
Raster compose(const Raster& picture, const Page& page);

}  // namespace twinray
