// SPDX-License-Identifier: MIT
#include "viewer/picture/color_map.h"

#include <algorithm>
#include <span>

namespace twinray {
namespace {

// Every 17th of the 256 published colours of viridis; those in between are within 7 of 255 of a straight line.
constexpr std::array<Rgb, 16> viridis = {{{68, 1, 84},
                                          {72, 26, 108},
                                          {71, 47, 125},
                                          {65, 68, 135},
                                          {57, 86, 140},
                                          {49, 104, 142},
                                          {42, 120, 142},
                                          {35, 136, 142},
                                          {31, 152, 139},
                                          {34, 168, 132},
                                          {53, 183, 121},
                                          {84, 197, 104},
                                          {122, 209, 81},
                                          {165, 219, 54},
                                          {210, 226, 27},
                                          {253, 231, 37}}};

// Sixteenths of the published map of Moreland; those in between are as near.
constexpr std::array<Rgb, 17> cool_to_warm = {{{59, 76, 192},
                                               {78, 104, 216},
                                               {98, 130, 234},
                                               {119, 154, 247},
                                               {141, 176, 254},
                                               {163, 194, 254},
                                               {185, 208, 249},
                                               {204, 217, 237},
                                               {221, 220, 220},
                                               {235, 211, 198},
                                               {244, 197, 173},
                                               {247, 177, 148},
                                               {244, 154, 123},
                                               {236, 127, 99},
                                               {222, 97, 77},
                                               {203, 62, 56},
                                               {180, 4, 38}}};

std::uint8_t mixed(std::uint8_t a, std::uint8_t b, double weight) {
    return static_cast<std::uint8_t>(std::lround(a + (b - a) * weight));
}

Rgb interpolated(std::span<const Rgb> colors, double position) {
    const double place = std::clamp(position, 0.0, 1.0) * static_cast<double>(colors.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), colors.size() - 2);
    const Rgb a = colors[below], b = colors[below + 1];
    const double weight = place - static_cast<double>(below);
    return {mixed(a.r, b.r, weight), mixed(a.g, b.g, weight), mixed(a.b, b.b, weight)};
}

}  // namespace

Rgb color_at(ColorMap map, double position) {
    return map == ColorMap::diverging ? interpolated(cool_to_warm, position) : interpolated(viridis, position);
}

}  // namespace twinray
