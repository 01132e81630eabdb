// SPDX-License-Identifier: MIT
#include "report/page/ci_formats.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace twinray::report {
namespace {

Record record(const char* id, const char* backend, std::optional<bool> pass, const char* fault_of = "") {
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
    Record advised = record("K79", "hw", false, "driver");
    advised.results = {{"demand", "should"}};
    Record absent = record("N11", "", {});
    absent.was_run = false, absent.reason = "needs 4 GiB";
    return {record("W04", "sw", true), record("W04", "hw", true), record("W04", "hw", false, "driver"), advised,
            absent};
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
    EXPECT_EQ(checks_of(std::vector{record("W04", "sw", false, "twinray")}, false)[0].outcome, Outcome::failed);
}

TEST(Checks, JunitCountsAndEscapes) {
    const std::string xml = junit_xml(checks_of(some(), true));
    EXPECT_NE(xml.find("<testsuite name=\"a &lt;device&gt;\" tests=\"4\" failures=\"1\" skipped=\"2\">"),
              std::string::npos)
        << xml;
    EXPECT_NE(xml.find("<testcase classname=\"W04\" name=\"W04 sw watertight\"/>"), std::string::npos);
    EXPECT_NE(xml.find("<failure message=\"fault of the driver; 3 of 100; HW_LEAK 0x1p+0\"/>"), std::string::npos);
}

TEST(Checks, TapHasALineEach) {
    const std::string lines = tap(checks_of(some(), false));
    EXPECT_TRUE(lines.starts_with("TAP version 14\n1..4\nok 1 - W04 sw watertight on a <device>\n")) << lines;
    EXPECT_NE(lines.find("not ok 2 - W04 hw watertight on a <device> # TODO fault of the driver"), std::string::npos);
    EXPECT_NE(lines.find("ok 4 - N11 on a <device> # SKIP needs 4 GiB"), std::string::npos);
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
