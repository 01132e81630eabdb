// SPDX-License-Identifier: MIT
// Plots of the page.
#pragma once

#include <filesystem>
#include <string>

#include "validation/report/plots.h"

namespace twinray::report {

// An array of plots, as draw_plots.py reads them.
std::string to_json(std::span<const Plot> plots);

// Writes plots.json and draw_plots.py into the folder and starts the script, which draws the same plots with matplotlib
// as plots/*.svg and *.png. Returns a sentence that says what came of it: without python3 or matplotlib nothing is
// drawn. Throws Error naming the file that cannot be written.
std::string draw_figures(const std::filesystem::path& folder, std::span<const Plot> plots);

}  // namespace twinray::report
