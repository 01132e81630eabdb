// SPDX-License-Identifier: MIT
// Which plots a report has: records in, points out.
#include "validation/report/plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "validation/suite/suite.h"

namespace twinray::report {
namespace {

using PointOf = std::function<std::optional<PlotPoint>(const Record&)>;

std::string label_of(const Record& record) {
    std::string label = record.case_id;
    for (const auto& [name, value] : record.params) label += ", " + name + ' ' + value.text();
    return label;
}

// A kernel of its own is a curve of its own; that fast is a control in some case makes no other kernel of it.
std::string curve_of(const Record& record) {
    const std::string configuration = record.level.empty() ? record.backend : record.backend + ' ' + record.level;
    return is_users_kernel(record) ? configuration : configuration + ", " + record.variant;
}

PlotPoint timed_point(const Record& record) {
    PlotPoint point;
    point.label = label_of(record);
    point.time = record.time->median;
    point.time_95 = record.time->median_95;
    return point;
}

bool is_of_rays(const Record& record) { return record.time && record.time->metric.starts_with("ns_per_ray"); }

std::optional<PlotPoint> fault_rate(const Record& record) {
    if (!is_of_rays(record) || !record.bound95 || record.n == 0) return std::nullopt;
    PlotPoint point = timed_point(record);
    point.is_zero = record.faults == 0;
    point.error = point.is_zero ? *record.bound95 : static_cast<double>(record.faults) / static_cast<double>(record.n);
    point.error_95 = point.is_zero ? Interval{point.error, point.error} : rate_interval_95(record.faults, record.n);
    return point;
}

std::optional<PlotPoint> t_error(const Record& record) {
    if (!is_of_rays(record) || !record.error || !(record.error->p99 > 0)) return std::nullopt;
    PlotPoint point = timed_point(record);
    point.error = record.error->p99;
    point.error_95 = record.error->p99_95;
    return point;
}

// How the errors of estimates are called on an axis, by metric; "" where it is none.
std::string axis_of(const std::string& metric) {
    static const std::map<std::string, std::string> names = {{"relative", "median relative error"},
                                                             {"relMSE", "median relative mean squared error"},
                                                             {"variance", "median variance of a pixel"},
                                                             {"FLIP", "median FLIP"}};
    const auto found = names.find(metric);
    return found == names.end() ? "" : found->second;
}

// Of estimates, over their seeds. An error below that of the number's type is none.
std::optional<PlotPoint> estimate_error(const Record& record) {
    if (!record.time || !record.error || axis_of(record.error->metric).empty()) return std::nullopt;
    PlotPoint point = timed_point(record);
    point.is_zero = record.error->median < record.error->floor;
    point.error = std::max(record.error->median, record.error->floor);
    point.error_95 = {point.error, point.error};
    return point;
}

bool is_drawable(const PlotPoint& point) {
    const auto is_positive = [](double value) { return value > 0 && std::isfinite(value); };
    return is_positive(point.error) && is_positive(point.time);
}

std::optional<PowerLaw> fit_of(const std::vector<PlotPoint>& points) {
    std::vector<double> errors, times;
    for (const PlotPoint& point : points)
        if (!point.is_zero) {
            errors.push_back(point.error);
            times.push_back(point.time);
        }
    return fit_power_law(errors, times);
}

// One curve a configuration, in the order of their first records.
std::vector<PlotCurve> curves_of(std::span<const Record* const> records, const PointOf& point_of, bool with_fit) {
    std::vector<PlotCurve> curves;
    for (const Record* record : records) {
        if (!record->was_run) continue;
        const std::optional<PlotPoint> point = point_of(*record);
        if (!point || !is_drawable(*point)) continue;
        const std::string name = curve_of(*record);
        auto curve = std::find_if(curves.begin(), curves.end(), [&](const PlotCurve& c) { return c.name == name; });
        if (curve == curves.end()) curve = curves.insert(curves.end(), PlotCurve{name, 0, {}, {}});
        curve->points.push_back(*point);
    }
    for (PlotCurve& curve : curves) {
        std::stable_sort(curve.points.begin(), curve.points.end(),
                         [](const PlotPoint& a, const PlotPoint& b) { return a.error < b.error; });
        if (with_fit) curve.fit = fit_of(curve.points);
    }
    return curves;
}

void add_plot(std::vector<Plot>& plots, Plot plot) {
    if (!plot.curves.empty()) plots.push_back(std::move(plot));
}

std::optional<double> floor_of(std::span<const Record* const> records) {
    for (const Record* record : records)
        if (record->error && record->error->floor > 0) return record->error->floor;
    return std::nullopt;
}

// Points of different cases lie on no common line: with_fit is for the settings of one.
Plot t_plot(const std::string& id, const std::string& title, std::span<const Record* const> records, bool with_fit) {
    return {id + "-t",    title + ": error of t", "99th percentile of the error of t, units in the last place",
            "ns per ray", floor_of(records),      curves_of(records, t_error, with_fit)};
}

// "ms_per_estimate" as it is said.
std::string spaced(std::string metric) {
    std::replace(metric.begin(), metric.end(), '_', ' ');
    return metric;
}

// For each setting of a case but for the number of rays, or of samples a pixel, over which its curves go.
std::vector<Plot> estimate_plots(const std::string& id, std::span<const Record* const> records) {
    std::vector<std::string> settings;
    std::map<std::string, std::vector<const Record*>> by_setting;
    for (const Record* record : records) {
        if (!estimate_error(*record)) continue;
        std::string setting;
        for (const auto& [name, value] : record->params)
            if (name != "rays" && name != "spp") setting += (setting.empty() ? "" : ", ") + name + ' ' + value.text();
        std::vector<const Record*>& same = by_setting[setting];
        if (same.empty()) settings.push_back(setting);
        same.push_back(record);
    }
    std::vector<Plot> plots;
    for (const std::string& setting : settings) {
        const std::vector<const Record*>& same = by_setting[setting];
        plots.push_back({id + "-error-" + std::to_string(plots.size() + 1),
                         id + (setting.empty() ? "" : ", " + setting) + ": error of estimates",
                         axis_of(same.front()->error->metric), spaced(same.front()->time->metric), floor_of(same),
                         curves_of(same, estimate_error, true)});
    }
    return plots;
}

Plot fault_plot(const std::string& id, const std::string& title, std::span<const Record* const> records,
                bool with_fit) {
    return {id + "-faults",
            title + ": faults",
            "faults per ray (0 of n: at the 95 % bound 3 / n)",
            "ns per ray",
            {},
            curves_of(records, fault_rate, with_fit)};
}

// Has a curve with three settings or more that shows an error at all.
bool is_swept(const Plot& plot) {
    const auto shows_error = [](const PlotPoint& point) { return !point.is_zero; };
    return std::any_of(plot.curves.begin(), plot.curves.end(), [&](const PlotCurve& curve) {
        return curve.points.size() >= 3 && std::any_of(curve.points.begin(), curve.points.end(), shows_error);
    });
}

// The n-th name that appears has style n.
void set_styles(std::vector<Plot>& plots) {
    std::vector<std::string> names;
    for (Plot& plot : plots)
        for (PlotCurve& curve : plot.curves) {
            const auto found = std::find(names.begin(), names.end(), curve.name);
            curve.style = static_cast<std::size_t>(found - names.begin());
            if (found == names.end()) names.push_back(curve.name);
        }
}

}  // namespace

bool is_users_kernel(const Record& record) { return record.variant.empty() || record.level == "fast"; }

std::vector<Plot> plots_of(std::span<const Record> records) {
    std::map<char, std::vector<const Record*>> sections;
    std::map<std::string, std::vector<const Record*>> cases;
    std::vector<char> section_order;
    std::vector<std::string> case_order;
    for (const Record& record : records) {
        if (record.case_id.empty()) continue;
        std::vector<const Record*>& section = sections[record.case_id.front()];
        if (section.empty()) section_order.push_back(record.case_id.front());
        section.push_back(&record);
        std::vector<const Record*>& same_case = cases[record.case_id];
        if (same_case.empty()) case_order.push_back(record.case_id);
        same_case.push_back(&record);
    }
    std::vector<Plot> plots;
    for (const char letter : section_order) {
        const std::string id(1, letter), title = id + ": " + std::string(suite::section_of(id));
        add_plot(plots, fault_plot(id, title, sections[letter], false));
        add_plot(plots, t_plot(id, title, sections[letter], false));
    }
    for (const std::string& id : case_order) {
        std::vector<Plot> of_case = estimate_plots(id, cases[id]);
        of_case.push_back(fault_plot(id, id, cases[id], true));
        of_case.push_back(t_plot(id, id, cases[id], true));
        for (Plot& plot : of_case)
            if (is_swept(plot)) plots.push_back(std::move(plot));
    }
    set_styles(plots);
    return plots;
}

}  // namespace twinray::report
