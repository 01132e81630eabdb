// SPDX-License-Identifier: MIT
// Figures, drawn by gnuplot.
#pragma once

#include <filesystem>

#include "report/page/figure.h"

namespace twinray::report {

// Where a text may be written: fractions of the plot's width and height, from below.
struct LabelPlace {
    double x = 0, y = 0;
};
// The same places, those near each other in x moved apart in y, as little as that takes from below upwards: a pure
// function.
std::vector<LabelPlace> apart(std::vector<LabelPlace> places);

// 1, 2 and 5 times powers of ten between low and high, or more of them where those are few; none where that is over 30
// to 1, and powers of ten do.
std::vector<double> log_tics(double low, double high);

// The script that writes `svg`: a pure function. Text and axes are in `text_color`, which a page replaces by its own.
inline constexpr const char* text_color = "#010203";
std::string gnuplot_script(const Figure& figure, const std::filesystem::path& svg);

// Writes <folder>/<id>.gp and draws it as <id>.svg, whose text it returns as an element of a page: as wide as there is
// room, its text in the page's colour. "" where gnuplot is not installed. Throws Error naming the script if gnuplot
// cannot draw it.
std::string draw(const Figure& figure, const std::filesystem::path& folder);

}  // namespace twinray::report
