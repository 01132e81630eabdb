// A report's page, its figures, and the same results in the formats of continuous integration.
#include "report/page/page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "report/page/ci_formats.h"
#include "report/page/figure.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"

namespace twinray::report {
namespace {

Record record(const char* id, const char* level, double ns, std::optional<bool> pass = true) {
    Record result;
    result.device = {"llvm<pipe> & co", "Mesa", "1.4", {{"fma_fused", false}}};
    result.case_id = id;
    result.backend = "sw";
    result.level = level;
    result.n = 1000;
    result.counts = {{"AGREE", 1000}};
    result.bound95 = upper_bound_95(0, 1000);
    result.pass = pass;
    result.error = ErrorFigures{"t_ulp", 0.5, 2.25, {2, 3}, 7, 0.5};
    result.time = TimeFigures{"ns_per_ray", ns, {ns, ns}, 0, ns, 3};
    return result;
}

std::string page_of(const std::vector<Record>& records, const std::vector<Change>& changes = {},
                    const std::string& baseline = {}) {
    static const std::vector<suite::SuiteCase> rows = suite::catalogue();
    static const std::vector<frame::Case> catalogue(rows.begin(), rows.end());
    return page({.suite = "quick",
                 .catalogue = catalogue,
                 .records = records,
                 .baseline = baseline,
                 .changes = changes,
                 .figures = {{Figure{.id = "leaks", .title = "Leaks"}, "<svg id=\"drawn\"></svg>"}}});
}

bool has(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

TEST(Page, ShowsDeviceProbeCaseAndResultAndRefersToNothingOutside) {
    const std::string page = page_of({record("W01", "watertight", 400)});
    for (const char* part :
         {"llvm&lt;pipe&gt; &amp; co", "<dt>fma_fused</dt><dd>false</dd>", "<details id=\"W01\">",
          "only SwTlas was checked", "<td>2.25</td><td>400</td><td class=\"pass\">pass</td>", "<svg id=\"drawn\">"})
        test::expect_contains(page, part);
    for (const char* outside : {"src=", "href=\"http", "<script", "@import", "url("})
        EXPECT_FALSE(has(page, outside)) << outside;
}

TEST(Page, AFaultOfOursIsInTheFirstLine) {
    Record bad = record("W04", "watertight", 400, false);
    bad.fault_of = "twinray";
    bad.faults = 3;
    bad.example = "SW_LEAK 0x1p+0";
    bad.replay = "replays/W04-1.json";
    const std::string page = page_of({bad});
    EXPECT_TRUE(has(page, "<p class=\"headline bad\">twinray is wrong in 1 measurement."));
    EXPECT_TRUE(has(page, "SW_LEAK 0x1p+0"));
    EXPECT_TRUE(has(page, "<a href=\"replays/W04-1.json\">replay</a>"));
}

TEST(Page, ListsWhatWasNotRunByReason) {
    Record first = record("B11", "", 0), second = record("B13", "", 0);
    for (Record* skipped : {&first, &second}) {
        skipped->was_run = false;
        skipped->backend.clear();
        skipped->pass.reset();
        skipped->reason = "nobody wrote it";
    }
    EXPECT_TRUE(has(page_of({first, second}), "<tr><td>all</td><td>B11 B13</td><td>nobody wrote it</td></tr>"));
}

TEST(Page, ShowsWhatChangedSinceTheBaseline) {
    const std::vector<Record> records = {record("W01", "watertight", 400)};
    EXPECT_TRUE(has(page_of(records, {{Change::Kind::slower, "W01 sw", "ns 1 -> 2"}}, "old.jsonl"),
                    "<li class=\"slower\">W01 sw: ns 1 -&gt; 2</li>"));
    EXPECT_TRUE(has(page_of(records, {}, "old.jsonl"), "<p>Nothing beyond noise.</p>"));
    EXPECT_FALSE(has(page_of(records), "id=\"baseline\""));
}

TEST(Page, SaysWhichPlotsCouldNotBeDrawn) {
    const std::vector<Record> records = {record("W01", "watertight", 400)};
    const PageInput input{.suite = "quick",
                          .catalogue = {},
                          .records = records,
                          .figures = {{Figure{.id = "leaks", .title = "Leaks"}, ""}}};
    EXPECT_TRUE(has(page(input), "gnuplot is not installed"));
}

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
    for (const char* part : {"set logscale x", "\"SwTlas watertight\" 0", "set arrow from 2991", "46000 1 33"})
        test::expect_contains(script, part);
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
    test::expect_contains(svg, "currentColor");
    for (const char* left : {"#010203", "rgb(1,2,3)", "rgb(  1,   2,   3)", "color=\"black\""})
        EXPECT_EQ(svg.find(left), std::string::npos) << left;
    test::expect_contains(svg, "hits &amp; more");
    EXPECT_EQ(svg.find("<script"), std::string::npos);
}

Record checked_record(const char* id, const char* backend, std::optional<bool> pass, const char* fault_of = "") {
    Record result;
    result.device.name = "a <device>";
    result.case_id = id;
    result.backend = backend;
    result.level = backend == std::string() ? "" : "watertight";
    result.criterion = "0 leaks";
    result.n = 100;
    result.pass = pass;
    result.fault_of = fault_of;
    result.faults = pass.value_or(true) ? 0 : 3;
    result.example = pass.value_or(true) ? "" : "HW_LEAK 0x1p+0";
    return result;
}

std::vector<Record> some() {
    Record advised = checked_record("K79", "hw", false, "driver");
    advised.results = {{"demand", "should"}};
    Record absent = checked_record("N11", "", {});
    absent.was_run = false, absent.reason = "needs 4 GiB";
    return {checked_record("W04", "sw", true), checked_record("W04", "hw", true),
            checked_record("W04", "hw", false, "driver"), advised, absent};
}

using Outcome = Check::Outcome;

TEST(Checks, AreTheWorstOfTheirSettings) {
    const std::vector<Check> checks = checks_of(some(), false);
    ASSERT_EQ(checks.size(), 4u);
    EXPECT_EQ(checks[0].outcome, Outcome::passed);
    EXPECT_EQ(checks[1].outcome, Outcome::tolerated);
    EXPECT_EQ(checks[1].n, 200u);
    EXPECT_EQ(checks[1].message, "fault of the driver; 3 of 100; HW_LEAK 0x1p+0");
    EXPECT_EQ(checks[3].outcome, Outcome::skipped);
    EXPECT_EQ(checks[3].message, "needs 4 GiB");
}

TEST(Checks, StrictlyTheDriverFailsWhatVulkanDemands) {
    const std::vector<Check> checks = checks_of(some(), true);
    EXPECT_EQ(checks[1].outcome, Outcome::failed);
    EXPECT_EQ(checks[2].outcome, Outcome::tolerated) << "only advised";
    EXPECT_EQ(checks_of(std::vector{checked_record("W04", "sw", false, "twinray")}, false)[0].outcome, Outcome::failed);
}

TEST(Checks, JunitCountsAndEscapes) {
    const std::string xml = junit_xml(checks_of(some(), true));
    test::expect_contains(xml, "<testsuite name=\"a &lt;device&gt;\" tests=\"4\" failures=\"1\" skipped=\"2\">");
    test::expect_contains(xml, "<testcase classname=\"W04\" name=\"W04 sw watertight\"/>");
    test::expect_contains(xml, "<failure message=\"fault of the driver; 3 of 100; HW_LEAK 0x1p+0\"/>");
}

TEST(Checks, TapHasALineEach) {
    const std::string lines = tap(checks_of(some(), false));
    EXPECT_TRUE(lines.starts_with("TAP version 14\n1..4\nok 1 - W04 sw watertight on a <device>\n")) << lines;
    test::expect_contains(lines, "not ok 2 - W04 hw watertight on a <device> # TODO fault of the driver");
    test::expect_contains(lines, "ok 4 - N11 on a <device> # SKIP needs 4 GiB");
}

TEST(Checks, SarifHasAResultForEachFault) {
    const auto log = nlohmann::json::parse(sarif(checks_of(some(), true), "0.1"));
    const auto& run = log.at("runs").at(0);
    ASSERT_EQ(run.at("results").size(), 2u);
    EXPECT_EQ(run.at("results").at(0).at("level"), "error");
    EXPECT_EQ(run.at("results").at(1).at("level"), "warning");
    EXPECT_EQ(run.at("tool").at("driver").at("rules").size(), 2u);
    EXPECT_EQ(log.at("version"), "2.1.0");
}

}  // namespace
}  // namespace twinray::report
