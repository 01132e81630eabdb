// SPDX-License-Identifier: MIT
#include <twinray/analysis.h>

#include <cmath>
#include <numbers>
#include <string>

#include "engine/core/error.h"

namespace twinray {
namespace {

// Patches of Tregenza's rows, 12 degrees high each, from the horizon to the zenith's patch of half the height.
constexpr int tregenza_rows[] = {30, 30, 24, 24, 18, 12, 6};

int divisions_of(std::string_view name) {
    if (name == sky_names[0]) return 1;
    if (name == sky_names[1]) return 2;
    if (name == sky_names[2]) return 4;
    fail("sky '", std::string(name), "' is not one of tregenza145, reinhart577, reinhart2305");
}

}  // namespace

std::vector<SkyPatch> sky_patches(std::string_view name) {
    using std::numbers::pi;
    const int m = divisions_of(name);
    const int rows = static_cast<int>(std::size(tregenza_rows)) * m;
    const double height = pi / 2 / (rows + 0.5);
    std::vector<SkyPatch> patches;
    for (int row = 0; row < rows; ++row) {
        const int count = tregenza_rows[row / m] * m;
        const double altitude = (row + 0.5) * height;
        const double area = 2 * pi / count * (std::sin((row + 1) * height) - std::sin(row * height));
        for (int i = 0; i < count; ++i) {
            const double azimuth = 2 * pi * i / count;
            patches.push_back({dvec3(std::sin(azimuth) * std::cos(altitude), std::cos(azimuth) * std::cos(altitude),
                                     std::sin(altitude)),
                               area});
        }
    }
    patches.push_back({dvec3(0, 0, 1), 2 * pi * (1 - std::sin(rows * height))});
    return patches;
}

}  // namespace twinray
