// The plots of a report: records in, points out. Pure functions; plotting is gnuplot's.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "validation/records/record.h"

namespace twinray::report {

struct FigurePoint {
    double x = 0, y = 0;
    Interval x_95 = {0, 0}, y_95 = {0, 0};  // no bar where both ends are the value
    std::string label = {};                 // written beside it
    bool is_bound = false;                  // no event was seen: x is the bound of the rate, which may be lower
};

struct FigureSeries {
    std::string label;      // written at its end; "" = its points have labels of their own
    std::size_t color = 0;  // the same for a thing in all figures: see color_of()
    bool is_joined = true;  // by a line
    std::vector<FigurePoint> points = {};
};

struct Figure {
    std::string id, title;
    std::string sentence = {};  // what the figure shows
    std::string x_label = {}, y_label = {};
    bool is_log_x = true, is_log_y = true;
    std::vector<std::string> rows = {};  // names of y = 0, 1, ..., from above: y has no scale then
    std::optional<double> mark_x = {};   // a line at the value that all are compared with
    std::vector<FigureSeries> series = {};
};

// Returns 0 for SwTlas, 1 for the driver's ray queries, 2 for its pipelines, 3 for anything else.
std::size_t color_of(std::string_view backend);

// Returns the five figures that matter, in this order, without those that have no point.
//   levels: error of t against the time of a trace, a point for each accelerator and level, and the front of those that
//           no other beats in both
//   leaks: rays lost at edges and vertices, with 95 % intervals
//   paths: error of the path tracer's pictures against seconds, with the slope
//   estimates: error of view factors, light and centroids against milliseconds, with the slope
//   features: time of a trace with features that its scene does not need, over the time without
std::vector<Figure> figures_of(std::span<const Record> records);
Figure leaks_figure(std::span<const Record> records);
Figure estimates_figure(std::span<const Record> records);

// Returns the points that no other beats in both x and y, by ascending x.
std::vector<FigurePoint> front_of(std::vector<FigurePoint> points);

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
