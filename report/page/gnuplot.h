// SPDX-License-Identifier: MIT
// Figures, drawn by gnuplot.
#pragma once

#include <filesystem>

#include "report/page/figure.h"

namespace twinray::report {

// The place of a text: fractions of the plot's width and height, from below.
struct LabelPlace {
    double x = 0, y = 0;
};
// Moves places that are near each other in x apart in y, from below upwards and as little as possible: a pure function.
std::vector<LabelPlace> apart(std::vector<LabelPlace> places);

// Returns 1, 2 and 5 times powers of ten between low and high, or more numbers if those are few; none if two powers of
// ten or more are between them, which suffice.
std::vector<double> log_tics(double low, double high);

// Returns the script that writes `svg`: a pure function. Text and axes are in `text_color`, which a page replaces by
// its own.
inline constexpr const char* text_color = "#010203";
std::string gnuplot_script(const Figure& figure, const std::filesystem::path& svg);

// Writes <folder>/<id>.gp and draws it as <id>.svg. Returns the svg as an element of a page, as wide as there is room
// and with its text in the page's colour, or "" if gnuplot is not installed. Throws Error naming the script if gnuplot
// cannot draw it.
std::string draw(const Figure& figure, const std::filesystem::path& folder);

}  // namespace twinray::report
