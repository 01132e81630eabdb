// SPDX-License-Identifier: MIT
#include "validation/report/figure.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/error.h"
#include "validation/report/verdict.h"
#include "validation/report/wording.h"

namespace twinray::report {
namespace {

std::string short_name(std::string_view backend) {
    if (backend == "sw") return "SwTlas";
    if (backend == "hw") return "ray query";
    if (backend == "hw-pipeline") return "pipeline";
    return std::string(backend);
}

double number_at(const Values& values, const std::string& name) {
    const auto found = values.find(name);
    const double* number = found == values.end() ? nullptr : std::get_if<double>(&found->second.is);
    return number ? *number : 0;
}

std::string text_at(const Values& values, const std::string& name) {
    const auto found = values.find(name);
    return found == values.end() ? "" : found->second.text();
}

// By name, in the order of their first appearance.
FigureSeries& series_of(std::vector<FigureSeries>& all, const std::string& label, std::size_t color) {
    for (FigureSeries& series : all)
        if (series.label == label) return series;
    return all.emplace_back(FigureSeries{.label = label, .color = color, .points = {}});
}

// y ~ x^slope, written behind the series' label.
void add_slopes(std::vector<FigureSeries>& all) {
    for (FigureSeries& series : all) {
        std::vector<double> x, y;
        for (const FigurePoint& point : series.points) x.push_back(point.x), y.push_back(point.y);
        if (const auto law = fit_power_law(x, y)) series.label += ", slope " + number(law->slope, 2);
    }
}

}  // namespace

std::size_t color_of(std::string_view backend) {
    return backend == "sw" ? 0 : backend == "hw" ? 1 : backend == "hw-pipeline" ? 2 : 3;
}

std::vector<FigurePoint> front_of(std::vector<FigurePoint> points) {
    std::sort(points.begin(), points.end(),
              [](const FigurePoint& a, const FigurePoint& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<FigurePoint> front;
    for (const FigurePoint& point : points)
        if (front.empty() || point.y < front.back().y) front.push_back(point);
    return front;
}

Figure levels_figure(std::span<const Record> records) {
    Figure figure{.id = "levels",
                  .title = "Error of t against run time",
                  .sentence =
                      "Left is faster, down is more exact; the line joins what nothing beats in both. Each point "
                      "is a level of an accelerator, over all cases that measured it.",
                  .x_label = "time of a trace over SwTlas at watertight (geometric mean, 95 %)",
                  .y_label = "error of t in ulp, 99th percentile"};
    std::vector<FigurePoint> all;
    for (const Speed& speed : speeds_of(records)) {
        if (speed.median_p99_ulp <= 0) continue;
        const FigurePoint point{speed.ratio,
                                speed.median_p99_ulp,
                                speed.ratio_95,
                                {speed.median_p99_ulp, speed.median_p99_ulp},
                                short_name(speed.backend) + ' ' + speed.level};
        figure.series.push_back({"", color_of(speed.backend), false, {point}});
        all.push_back({point.x, point.y, {point.x, point.x}, {point.y, point.y}});
    }
    if (!all.empty()) figure.series.insert(figure.series.begin(), {"", 4, true, front_of(all)});
    return figure;
}

Figure leaks_figure(std::span<const Record> records) {
    Figure figure{.id = "leaks",
                  .title = "Rays lost at shared edges and vertices",
                  .sentence =
                      "Each ray is aimed at an edge or a vertex of a closed surface and must hit. An arrow to the "
                      "left: none was lost, and the mark is the largest rate that this leaves possible (95 %).",
                  .x_label = "lost rays per million",
                  .is_log_y = false};
    std::map<std::pair<std::size_t, std::string>, std::pair<std::uint64_t, std::uint64_t>> sums;
    std::map<std::size_t, std::string> names;
    for (const Record& record : records) {
        if (!record.was_run || !record.case_id.starts_with('W') || record.reference != "f64" || record.counts.empty())
            continue;
        if (!is_users_kernel(record) && record.level != "fast") continue;
        auto& [lost, n] = sums[{color_of(record.backend), record.level}];
        for (const char* kind : {"SW_LEAK", "HW_LEAK"})
            if (const auto found = record.counts.find(kind); found != record.counts.end()) lost += found->second;
        n += record.n;
        names[color_of(record.backend)] = short_name(record.backend);
    }
    for (const auto& [key, sum] : sums) {
        const auto [lost, n] = sum;
        const Interval rate = rate_interval_95(lost, n);
        const double row = static_cast<double>(figure.rows.size());
        figure.rows.push_back(names[key.first] + ' ' + key.second);
        FigurePoint point{1e6 * static_cast<double>(lost) / static_cast<double>(n),
                          row,
                          {1e6 * rate.low, 1e6 * rate.high},
                          {row, row},
                          rate_text(lost, n)};
        if (lost == 0) {
            point.x = 1e6 * upper_bound_95(0, n);
            point.x_95 = {point.x, point.x};
            point.is_bound = true;
        }
        figure.series.push_back({"", key.first, false, {point}});
    }
    return figure;
}

Figure paths_figure(std::span<const Record> records) {
    Figure figure{.id = "paths",
                  .title = "Error of path traced pictures against seconds",
                  .sentence =
                      "The Cornell box with both ways of sampling (MIS): the error falls as samples are added; "
                      "how far left a line lies is how fast its accelerator is.",
                  .x_label = "seconds a picture",
                  .y_label = "relative mean squared error"};
    for (const Record& record : records) {
        if (!record.was_run || record.case_id != "P19" || record.variant != "MIS, sobol" || !record.error ||
            !record.time || record.error->metric != "relMSE")
            continue;
        const double seconds = record.time->median / 1e3, error = record.error->median;
        if (seconds > 0 && error > 0)
            series_of(figure.series, short_name(record.backend), color_of(record.backend))
                .points.push_back({seconds, error, {seconds, seconds}, {error, error}});
    }
    add_slopes(figure.series);
    return figure;
}

Figure factors_figure(std::span<const Record> records) {
    Figure figure{.id = "factors",
                  .title = "Error of view factors against rays",
                  .sentence =
                      "Two parallel squares as far apart as they are wide, whose view factor is known: points on "
                      "both (areas) need the fewest rays there, and Sobol's sequence fewer than random numbers.",
                  .x_label = "rays",
                  .y_label = "relative error (root mean square over seeds)"};
    std::map<std::string, std::size_t> colors;
    for (const Record& record : records) {
        const double rays = number_at(record.params, "rays"), error = number_at(record.results, "rms");
        if (!record.was_run || record.case_id != "V01" || number_at(record.params, "distance") != 1 || rays <= 0 ||
            error <= 0 || record.backend != "sw")
            continue;
        const std::size_t color = colors.emplace(record.variant, colors.size()).first->second;
        series_of(figure.series, record.variant, color).points.push_back({rays, error, {rays, rays}, {error, error}});
    }
    add_slopes(figure.series);
    return figure;
}

Figure features_figure(std::span<const Record> records) {
    Figure figure{.id = "features",
                  .title = "What leaving out saves",
                  .sentence =
                      "The same rays of a scene that needs none of this, by kernels to which one feature after the "
                      "other is added: what stands below costs a scene its time as soon as it is compiled in.",
                  .x_label = "time over the kernel with what is needed alone",
                  .is_log_x = false,
                  .is_log_y = false,
                  .mark_x = 1.0,
                  .series = {{"", 0, false, {}}}};
    for (const Record& record : records) {
        const double ratio = number_at(record.results, "of_needed");
        if (!record.was_run || record.case_id != "L04" || ratio <= 0 || text_at(record.params, "rays") != "closest")
            continue;
        const double row = static_cast<double>(figure.rows.size());
        figure.rows.push_back(text_at(record.params, "features"));
        figure.series[0].points.push_back(
            {ratio,
             row,
             {number_at(record.results, "of_needed_low"), number_at(record.results, "of_needed_high")},
             {row, row},
             number(ratio, 3)});
    }
    return figure;
}

std::vector<Figure> figures_of(std::span<const Record> records) {
    std::vector<Figure> figures;
    for (Figure& figure : std::vector{leaks_figure(records), levels_figure(records), paths_figure(records),
                                      factors_figure(records), features_figure(records)})
        if (std::any_of(figure.series.begin(), figure.series.end(), [](const auto& s) { return !s.points.empty(); }))
            figures.push_back(std::move(figure));
    return figures;
}

}  // namespace twinray::report
