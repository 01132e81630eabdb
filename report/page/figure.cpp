#include "report/page/figure.h"

#include <algorithm>
#include <map>

#include "engine/accel/trace_desc.h"
#include "engine/core/error.h"
#include "report/page/verdict.h"
#include "report/page/wording.h"

namespace twinray::report {
namespace {

std::string short_name(std::string_view backend) {
    if (backend == "sw") return "SwTlas";
    if (backend == "hw") return "ray query";
    if (backend == "hw-pipeline") return "pipeline";
    return std::string(backend);
}

std::string text_at(const Values& values, const std::string& name) {
    const auto found = values.find(name);
    return found == values.end() ? "" : found->second.text();
}

// Returns the series of this name; series are in the order of their first appearance.
FigureSeries& series_of(std::vector<FigureSeries>& all, const std::string& label, std::size_t color) {
    for (FigureSeries& series : all)
        if (series.label == label) return series;
    return all.emplace_back(FigureSeries{.label = label, .color = color, .points = {}});
}

// Fits y ~ x^slope and writes the slope behind the series' label in brackets.
void add_slopes(std::vector<FigureSeries>& all) {
    for (FigureSeries& series : all) {
        std::vector<double> x, y;
        for (const FigurePoint& point : series.points) x.push_back(point.x), y.push_back(point.y);
        if (const auto law = fit_power_law(x, y)) series.label += " (" + number(law->slope, 2) + ')';
    }
}

// Returns the label of an estimate in the plot, or "" for records that are not in it.
std::string estimated_by(const Record& record) {
    const auto is = [&](const char* id, const char* setting, std::string_view value) {
        return record.case_id == id && (!setting || text_at(record.params, setting) == value);
    };
    if (is("V01", "distance", "1")) return "factor, " + record.variant;
    if (is("G01", "light", "from above")) return "illumination";
    if (is("G04", nullptr, "")) return "sky light";
    if (is("G05", nullptr, "")) return "hours of sun";
    if (is("G06", nullptr, "")) return "centroid";
    return "";
}

Figure levels_figure(std::span<const Record> records) {
    Figure figure{.id = "levels",
                  .title = "Error of t against run time",
                  .sentence =
                      "Left is faster, and lower is more accurate. The line joins the points that no other point beats "
                      "in both. Each point is one level of an accelerator, over all cases that measured it.",
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

Figure paths_figure(std::span<const Record> records) {
    Figure figure{.id = "paths",
                  .title = "Error of path-traced pictures against seconds",
                  .sentence =
                      "The Cornell box with both ways of sampling (MIS). The error falls as samples are added; a line "
                      "farther left belongs to a faster accelerator.",
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

Figure features_figure(std::span<const Record> records) {
    Figure figure{
        .id = "features",
        .title = "What leaving out saves",
        .sentence =
            "The same rays in a scene that needs none of these features, traced by kernels to which one feature after "
            "the other is added. A feature costs a scene this time as soon as it is compiled in.",
        .x_label = "time relative to the kernel with only the needed features",
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

}  // namespace

std::size_t color_of(std::string_view backend) {
    return backend == "sw" ? 0 : backend == "hw" ? 1 : backend == "hw-pipeline" ? 2 : 3;
}

std::vector<FigurePoint> front_of(std::vector<FigurePoint> points) {
    std::ranges::sort(points,
                      [](const FigurePoint& a, const FigurePoint& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<FigurePoint> front;
    for (const FigurePoint& point : points)
        if (front.empty() || point.y < front.back().y) front.push_back(point);
    return front;
}

Figure leaks_figure(std::span<const Record> records) {
    Figure figure{.id = "leaks",
                  .title = "Rays lost at shared edges and vertices",
                  .sentence =
                      "Each ray is aimed at an edge or a vertex of a closed surface and must hit. An arrow to the left "
                      "means that no ray was lost; its mark is the largest rate that this leaves possible (95 %). Each "
                      "case has the same weight.",
                  .x_label = "lost rays per million",
                  .is_log_y = false};
    for (const char* backend : {"sw", "hw", "hw-pipeline"})
        for (const Level level : all_levels) {
            const Finding finding = finding_at(records, backend, name_of(level), Mistake::leak);
            if (finding.n() == 0) continue;
            const double row = static_cast<double>(figure.rows.size()), rate = 1e6 * finding.rate();
            const Interval rate_95 = finding.rate_95();
            figure.rows.push_back(short_name(backend) + ' ' + std::string(name_of(level)));
            FigurePoint point{
                rate, row, {1e6 * rate_95.low, 1e6 * rate_95.high}, {row, row}, rate_text(finding.rate(), rate_95)};
            if (rate == 0) {
                point.x = 1e6 * rate_95.high;
                point.x_95 = {point.x, point.x};
                point.is_bound = true;
                point.label = text("0 of ", count_text(finding.n()), " (below ", share_text(rate_95.high), ')');
            }
            figure.series.push_back({"", color_of(backend), false, {point}});
        }
    return figure;
}

Figure estimates_figure(std::span<const Record> records) {
    Figure figure{.id = "estimates",
                  .title = "Error of estimates against run time",
                  .sentence =
                      "Estimates by SwTlas whose true value is known in closed form: view factors of two squares, "
                      "light on a partly shadowed square, sky light and hours of sun there, and the mean height of the "
                      "visible points. Lower and farther left is better. The slope of each line is in brackets; the "
                      "steeper it is, the more additional rays gain.",
                  .x_label = "milliseconds per estimate",
                  .y_label = "relative error (root mean square over seeds)"};
    std::map<std::string, std::size_t> colors;
    for (const Record& record : records) {
        const std::string label = record.backend == "sw" && record.was_run ? estimated_by(record) : "";
        const double error = number_at(record.results, "rms");
        if (label.empty() || error <= 0 || !record.time || record.time->median <= 0) continue;
        const std::size_t color = colors.emplace(label, colors.size()).first->second;
        const TimeFigures& time = *record.time;
        series_of(figure.series, label, color).points.push_back({time.median, error, time.median_95, {error, error}});
    }
    add_slopes(figure.series);
    return figure;
}

std::vector<Figure> figures_of(std::span<const Record> records) {
    std::vector<Figure> figures;
    for (Figure& figure : std::vector{leaks_figure(records), levels_figure(records), paths_figure(records),
                                      estimates_figure(records), features_figure(records)})
        if (std::ranges::any_of(figure.series, [](const auto& s) { return !s.points.empty(); }))
            figures.push_back(std::move(figure));
    return figures;
}

}  // namespace twinray::report
