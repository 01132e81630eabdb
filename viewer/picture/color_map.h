// SPDX-License-Identifier: MIT
// Colours for values.
#pragma once

#include <twinray/scene.h>

namespace twinray {

enum class ColorMap : std::uint8_t {
    magnitude,  // viridis, from dark to bright in even steps of lightness (van der Walt and Smith 2015)
    diverging,  // blue to red through light grey in the middle, which is 0 (cool to warm, Moreland 2009)
};

// position: from 0 to 1; positions outside take the colour of the end.
Rgb color_at(ColorMap map, double position);

inline constexpr Rgb no_value_color = {158, 158, 158};

// Colours for kinds of things, which people of any colour vision can distinguish (Okabe and Ito 2008).
namespace categorical {
inline constexpr Rgb orange = {230, 159, 0}, sky_blue = {86, 180, 233}, green = {0, 158, 115}, yellow = {240, 228, 66},
                     blue = {0, 114, 178}, vermilion = {213, 94, 0}, purple = {204, 121, 167};
}  // namespace categorical

}  // namespace twinray
