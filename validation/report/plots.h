// SPDX-License-Identifier: MIT
// Work-precision plots: what a record's error costs in time, log-log.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "validation/records/record.h"

namespace twinray::report {

struct PlotPoint {
    std::string label;  // which case and parameters
    double error = 0;   // > 0
    Interval error_95;
    double time = 0;  // > 0
    Interval time_95;
    bool is_zero = false;  // no error was seen: `error` is the bound that the number of trials gives
};

struct PlotCurve {
    std::string name;               // "sw watertight"
    std::size_t style = 0;          // of colour and marker: the same for a name in all plots of a report
    std::vector<PlotPoint> points;  // by ascending error
    // Of time over error, without the zeros, where the points are the settings of one case; nothing under 3 of them.
    std::optional<PowerLaw> fit;
};

struct Plot {
    std::string id;  // "W04-t", for links and file names
    std::string title;
    std::string error_label, time_label;
    std::optional<double> floor;  // below which no error can lie
    std::vector<PlotCurve> curves;
};

// Whether users get the kernel: not compiled otherwise as a negative control.
bool is_users_kernel(const Record& record);

// For each section of the catalogue, over all its cases: the rate of faults, and the 99th percentile of the error of t,
// against time; then the same for each case that shows such an error and has three settings or more on one
// configuration, and for each of its settings the median error of estimates over numbers of rays. A rate of 0 stands at
// its 95 % bound, 3 / n, an error below that of rounding at that. Plots without a point are left out.
std::vector<Plot> plots_of(std::span<const Record> records);

// A decade-aligned range around what the plot shows.
Interval decades_around(double low, double high);

// An <svg> element that needs nothing else: curves with 95 % bars, arrows to the left at zeros, dashed fits with their
// slopes, a line at the floor.
std::string svg(const Plot& plot);

// "&" and "<" and quotes as XML wants them.
std::string escaped(std::string_view text);

}  // namespace twinray::report
