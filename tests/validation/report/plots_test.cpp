// SPDX-License-Identifier: MIT
#include "validation/report/plots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "validation/report/figures.h"

namespace twinray::report {
namespace {

Record point(const char* id, const char* level, double p99, double ns, int setting, std::uint64_t faults = 0) {
    Record record;
    record.case_id = id;
    record.params = {{"setting", setting}};
    record.backend = "sw";
    record.level = level;
    record.n = 1000;
    record.faults = faults;
    record.bound95 = upper_bound_95(faults, 1000);
    record.error = ErrorFigures{"t_ulp", p99 / 2, p99, {p99 * 0.9, p99 * 1.1}, p99 * 2, 0.5};
    record.time = TimeFigures{"ns_per_ray", ns, {ns * 0.9, ns * 1.1}, 1, ns, 15};
    return record;
}

const Plot* find(const std::vector<Plot>& plots, const std::string& id) {
    for (const Plot& plot : plots)
        if (plot.id == id) return &plot;
    return nullptr;
}

// Time = 1000 / error.
std::vector<Record> sweep() {
    return {point("S04", "watertight", 1, 1000, 0), point("S04", "watertight", 10, 100, 1),
            point("S04", "watertight", 100, 10, 2, 4), point("S04", "fast", 5, 50, 0, 9)};
}

TEST(Plots, ASweepHasItsSlopeAndASectionHasNone) {
    const std::vector<Plot> plots = plots_of(sweep());
    ASSERT_EQ(plots.size(), 4u);
    const Plot* swept = find(plots, "S04-t");
    ASSERT_TRUE(swept && swept->curves.size() == 2);
    ASSERT_TRUE(swept->curves[0].fit);
    EXPECT_NEAR(swept->curves[0].fit->slope, -1, 1e-12);
    EXPECT_FALSE(swept->curves[1].fit);
    EXPECT_EQ(swept->floor, 0.5);
    EXPECT_EQ(swept->curves[0].points[0].label, "S04, setting 0");
    ASSERT_TRUE(find(plots, "S-t"));
    EXPECT_FALSE(find(plots, "S-t")->curves[0].fit);
}

TEST(Plots, EstimatesHaveAPlotForEachSettingOverTheirRays) {
    std::vector<Record> records;
    for (const double distance : {1.0, 2.0})
        for (const double rays : {100.0, 1000.0, 10000.0, 0.0}) {
            Record record = point("V01", "", 0, rays > 0 ? rays / 10 : 1, 0);
            record.params = {{"distance", distance}};
            if (rays > 0) record.params.emplace("rays", rays);
            record.variant = rays > 0 ? "hits" : "contour";
            const double error = rays > 0 ? distance / std::sqrt(rays) : 1e-15;
            record.error = ErrorFigures{"relative", error, error, {error, error}, error, 1e-8};
            record.time->metric = "ms_per_estimate";
            records.push_back(record);
        }
    const std::vector<Plot> plots = plots_of(records);
    ASSERT_EQ(plots.size(), 2u);
    EXPECT_EQ(plots[1].id, "V01-error-2");
    EXPECT_EQ(plots[1].title, "V01, distance 2: error of estimates");
    ASSERT_EQ(plots[1].curves.size(), 2u);
    EXPECT_EQ(plots[1].curves[0].name, "sw, hits");
    ASSERT_TRUE(plots[1].curves[0].fit);
    EXPECT_NEAR(plots[1].curves[0].fit->slope, -2, 1e-9);
    const PlotPoint& contour = plots[1].curves[1].points.at(0);
    EXPECT_TRUE(contour.is_zero) << "below what the number's type rounds";
    EXPECT_EQ(contour.error, 1e-8);
}

TEST(Plots, ZeroStandsAtItsBound) {
    const std::vector<Plot> plots = plots_of(sweep());
    const Plot* faults = find(plots, "S-faults");
    ASSERT_TRUE(faults);
    const std::vector<PlotPoint>& points = faults->curves[0].points;
    EXPECT_TRUE(points[0].is_zero);
    EXPECT_EQ(points[0].error, upper_bound_95(0, 1000));
    EXPECT_FALSE(points[2].is_zero);
    EXPECT_EQ(points[2].error, 0.004);
    EXPECT_EQ(points[2].error_95, rate_interval_95(4, 1000));
}

TEST(Plots, ZerosAreNoPointsOfASlope) {
    std::vector<Record> records = {point("S04", "watertight", 1, 1e5, 0)};  // would tilt the line
    for (const std::uint64_t faults : {10u, 100u, 1000u})
        records.push_back(
            point("S04", "watertight", 1, 1e4 / static_cast<double>(faults), static_cast<int>(faults), faults));
    const std::vector<Plot> plots = plots_of(records);
    const Plot* swept = find(plots, "S04-faults");
    ASSERT_TRUE(swept && swept->curves[0].fit);
    EXPECT_NEAR(swept->curves[0].fit->slope, -1, 1e-12);
    EXPECT_EQ(swept->curves[0].fit->points, 3u);
    for (Record& record : records) record.faults = 0;
    EXPECT_FALSE(find(plots_of(records), "S04-faults")) << "a plot of zeros alone";
}

TEST(Plots, WhatWasNotRunOrTimedIsNotDrawn) {
    std::vector<Record> records = sweep();
    for (Record& record : records) record.time.reset();
    EXPECT_TRUE(plots_of(records).empty());
    EXPECT_TRUE(plots_of({}).empty());
    std::vector<Record> refits = sweep();
    for (Record& record : refits) record.time->metric = "ms_per_refit";
    EXPECT_TRUE(plots_of(refits).empty()) << "another unit";
}

TEST(Plots, RangesAreDecadesAroundThePoints) {
    EXPECT_EQ(decades_around(2, 30), (Interval{1, 100}));
    EXPECT_EQ(decades_around(1, 1), (Interval{0.1, 10}));
    EXPECT_EQ(decades_around(3, 3), (Interval{1, 10}));
    EXPECT_EQ(decades_around(INFINITY, 0), (Interval{0.1, 10}));
}

// Logarithmic axes of 540 - 70 and 330 - 34 units: a decade in error and one in time are as far apart everywhere.
TEST(Svg, PointsLieOnLogarithmicAxes) {
    const std::vector<Plot> plots = plots_of(sweep());
    const std::string drawing = svg(*find(plots, "S04-t"));
    const std::regex marker("class=\"point\"[^>]* d=\"M([0-9.]+) ([0-9.]+) m-4");
    std::vector<std::pair<double, double>> places;
    for (auto i = std::sregex_iterator(drawing.begin(), drawing.end(), marker); i != std::sregex_iterator(); ++i)
        places.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
    ASSERT_EQ(places.size(), 3u);
    EXPECT_NEAR(places[1].first - places[0].first, places[2].first - places[1].first, 0.11);
    EXPECT_NEAR(places[1].second - places[0].second, places[2].second - places[1].second, 0.11);
    EXPECT_GT(places[1].first, places[0].first) << "larger errors lie to the right";
    EXPECT_GT(places[1].second, places[0].second) << "shorter times lie below";
    // The error's axis has the decades 0.1 to 1000, of which 1 lies at a quarter.
    EXPECT_NEAR(places[0].first, 70 + 470.0 / 4, 0.06);
    EXPECT_NE(drawing.find("slope -1.00 [-1.00, -1.00]"), std::string::npos);
    EXPECT_NE(drawing.find("class=\"fit\""), std::string::npos);
    EXPECT_NE(drawing.find("floor: rounding"), std::string::npos);
}

TEST(Svg, AZeroHasAnArrow) {
    const std::vector<Plot> plots = plots_of(sweep());
    const std::string drawing = svg(*find(plots, "S-faults"));
    const std::regex arrow("class=\"zero\"");
    EXPECT_EQ(std::distance(std::sregex_iterator(drawing.begin(), drawing.end(), arrow), std::sregex_iterator()), 2);
    EXPECT_EQ(svg(*find(plots, "S04-t")).find("class=\"zero\""), std::string::npos);
}

TEST(Figures, TheScriptGetsTheSamePoints) {
    const std::vector<Plot> plots = plots_of(sweep());
    const auto json = nlohmann::json::parse(to_json(plots));
    ASSERT_EQ(json.size(), plots.size());
    for (std::size_t i = 0; i < plots.size(); ++i) {
        EXPECT_EQ(json[i]["id"], plots[i].id);
        for (std::size_t curve = 0; curve < plots[i].curves.size(); ++curve)
            for (std::size_t at = 0; at < plots[i].curves[curve].points.size(); ++at)
                EXPECT_EQ(json[i]["curves"][curve]["points"][at]["error"].get<double>(),
                          plots[i].curves[curve].points[at].error);
    }
}

}  // namespace
}  // namespace twinray::report
