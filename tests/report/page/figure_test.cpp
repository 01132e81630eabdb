// SPDX-License-Identifier: MIT
#include "report/page/figure.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"
#include "report/page/gnuplot.h"

namespace twinray::report {
namespace {

Record leaks(const char* backend, std::uint64_t lost, std::uint64_t n) {
    Record record;
    record.case_id = "W02";
    record.backend = backend;
    record.level = "watertight";
    record.reference = "f64";
    record.n = n;
    record.counts = {{backend == std::string("sw") ? "SW_LEAK" : "HW_LEAK", lost}, {"AGREE", n - lost}};
    return record;
}

Record estimate(const char* variant, double rays, double rms) {
    Record record;
    record.case_id = "V01";
    record.backend = "sw";
    record.variant = variant;
    record.params = {{"distance", 1.0}, {"rays", rays}};
    record.results = {{"rms", rms}};
    const double ms = rays / 1000;
    record.time = TimeFigures{"ms_per_estimate", ms, {ms, ms}, 0, ms, 8};
    return record;
}

TEST(Figure, LeaksHaveIntervalsAndBounds) {
    const Figure figure = leaks_figure(std::vector{leaks("hw", 46, 1000), leaks("sw", 0, 1000)});
    EXPECT_EQ(figure.rows, (std::vector<std::string>{"SwTlas watertight", "ray query watertight"}));
    const FigurePoint &ours = figure.series.at(0).points.at(0), &theirs = figure.series.at(1).points.at(0);
    EXPECT_TRUE(ours.is_bound);
    EXPECT_NEAR(ours.x, 1e6 * upper_bound_95(0, 1000), 1e-6);
    EXPECT_FALSE(theirs.is_bound);
    EXPECT_NEAR(theirs.x, 46'000, 1e-6);
    EXPECT_LT(theirs.x_95.low, theirs.x);
    EXPECT_GT(theirs.x_95.high, theirs.x);
}

TEST(Figure, SlopesAreOfThePointsOfALine) {
    const Figure figure = estimates_figure(
        std::vector{estimate("hits", 1024, 0.04), estimate("hits", 4096, 0.02), estimate("hits", 16384, 0.01)});
    ASSERT_EQ(figure.series.size(), 1u);
    EXPECT_EQ(figure.series[0].label, "factor, hits (-0.5)");
}

TEST(Figure, TheFrontIsWhatNothingBeatsInBoth) {
    const auto at = [](double x, double y) { return FigurePoint{.x = x, .y = y}; };
    const std::vector<FigurePoint> front = front_of({at(2, 5), at(1, 9), at(3, 6), at(4, 1), at(1, 10)});
    ASSERT_EQ(front.size(), 3u);
    EXPECT_EQ(front[0].y, 9);
    EXPECT_EQ(front[1].y, 5);
    EXPECT_EQ(front[2].y, 1);
}

TEST(Figure, WithoutPointsThereIsNone) { EXPECT_TRUE(figures_of({}).empty()); }

TEST(Gnuplot, LabelsThatAreNearEachOtherAreMovedApart) {
    const std::vector<LabelPlace> places = apart({{0.5, 0.5}, {0.5, 0.51}, {0.5, 0.9}, {0.05, 0.5}});
    EXPECT_EQ(places[0].y, 0.5);
    EXPECT_GE(places[1].y, 0.55);
    EXPECT_EQ(places[2].y, 0.9);
    EXPECT_EQ(places[3].y, 0.5);
}

TEST(Gnuplot, ShortAxesHaveNumbers) {
    EXPECT_EQ(log_tics(0.3, 4), (std::vector{0.5, 1.0, 2.0}));
    EXPECT_EQ(log_tics(0.009, 0.06).size(), 3u);
    EXPECT_EQ(log_tics(1.6, 4.9), (std::vector{2.0, 3.0, 4.0}));
    EXPECT_EQ(log_tics(0.25, 9), (std::vector{0.5, 1.0, 2.0, 5.0}));
    EXPECT_TRUE(log_tics(1, 1000).empty()) << "powers of ten will do";
}

TEST(Gnuplot, AScriptHoldsPointsBarsBoundsAndLabels) {
    const Figure figure = leaks_figure(std::vector{leaks("hw", 46, 1000), leaks("sw", 0, 1000)});
    const std::string script = gnuplot_script(figure, "plots/leaks.svg");
    EXPECT_NE(script.find("set logscale x"), std::string::npos);
    EXPECT_NE(script.find("\"SwTlas watertight\" 0"), std::string::npos);
    EXPECT_NE(script.find("set arrow from 2991"), std::string::npos) << script;
    EXPECT_NE(script.find("46000 1 33"), std::string::npos) << script;
    EXPECT_EQ(script.find("set logscale y"), std::string::npos);
}

TEST(Gnuplot, DrawsAnElementOfThePage) {
    const test::TempDir folder;
    const Figure figure =
        estimates_figure(std::vector{estimate("hits & more", 1024, 0.04), estimate("hits & more", 4096, 0.02)});
    const std::string svg = draw(figure, folder / "plots");
    EXPECT_TRUE(std::filesystem::exists(folder / "plots/estimates.gp"));
    if (svg.empty()) TWINRAY_LACKS("gnuplot", "gnuplot is not installed");
    EXPECT_TRUE(svg.starts_with("<svg"));
    EXPECT_NE(svg.find("currentColor"), std::string::npos);
    for (const char* left : {"#010203", "rgb(1,2,3)", "rgb(  1,   2,   3)", "color=\"black\""})
        EXPECT_EQ(svg.find(left), std::string::npos) << left;
    EXPECT_NE(svg.find("hits &amp; more"), std::string::npos);
    EXPECT_EQ(svg.find("<script"), std::string::npos);
}

}  // namespace
}  // namespace twinray::report
