// SPDX-License-Identifier: MIT
// The suite's runner, on a device.
#include <gtest/gtest.h>

#include <algorithm>

#include "report/replay/replay.h"
#include "report/replay/scene_file.h"
#include "report/page/verdict.h"
#include "report/suite/case_run.h"
#include "report/suite/checks.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "validation/reference/aimed_rays.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"

namespace twinray::suite {
namespace {

class SuiteRun : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!test::make_context()) return;
        devices_ = std::make_unique<Devices>(ContextDesc{.validation = true});
        can_run_ = true;
    }
    std::vector<Record> run(const std::vector<SuiteCase>& cases, const Settings& settings = {}) {
        Recorder recorder({"now", "0.1", {}});
        SuiteState state;
        suite::run(cases, settings, *devices_, recorder, state, true);
        EXPECT_TRUE(devices_->context(Backend::software).validation_messages().empty());
        return recorder.records();
    }
    bool can_run_ = false;
    std::unique_ptr<Devices> devices_;
};

SuiteCase make_case(const char* id, std::function<void(CaseRun&)> run) {
    return {id, "title", "measures", "criterion", std::move(run)};
}

// Of every second triangle, so that a reference of the whole finds leaks.
World world_with_holes() {
    World world = world_of(make_icosphere(3));
    Mesh holes = make_icosphere(3);
    for (std::size_t i = 0; i < holes.triangles.size(); i += 2) holes.triangles[i] = uvec3(0);
    world.fill = [holes](AbstractAccel& accel) { accel.push(holes); };
    return world;
}

std::vector<Ray> rays() { return random_rays({vec3(-1), vec3(1)}, 500, 1); }

const std::function<void(CaseRun&)> sound = [](CaseRun& run) { run.measure(world_of(make_icosphere(3)), rays()); };

// What is computed alike from the answers of both is the driver's fault where it is right by SwTlas.
TEST_F(SuiteRun, WhatIsRightBySoftwareIsTheDriversFault) {
    if (!can_run_) return;
    const auto computed = [](CaseRun& run) {
        for (const char* backend : {"sw", "hw"})
            for (const int setting : {1, 2}) {
                Record record = run.record({});
                record.backend = backend;
                record.params = {{"setting", setting}};
                record.pass = backend == std::string("sw") && setting == 1;
                run.add_computed(record);
            }
    };
    const std::vector<Record> records = run({make_case("P99", computed)});
    ASSERT_EQ(records.size(), 4u);
    EXPECT_EQ(records[0].fault_of, "");
    EXPECT_EQ(records[1].fault_of, "twinray");
    EXPECT_EQ(records[2].fault_of, "driver");
    EXPECT_EQ(records[3].fault_of, "twinray") << "SwTlas is wrong, too";
}

TEST_F(SuiteRun, EndsWhereTheDeviceIsLost) {
    if (!can_run_) return;
    const auto lost = [](CaseRun&) { throw DeviceLost("gone"); };
    Recorder recorder({"now", "0.1", {}});
    SuiteState state;
    EXPECT_EQ(suite::run(std::vector{make_case("W01", sound), make_case("W02", lost), make_case("W03", sound)}, {},
                         *devices_, recorder, state, true),
              "W02");
    const Record& last = recorder.records().back();
    EXPECT_EQ(last.case_id, "W03");
    EXPECT_FALSE(last.was_run);
    EXPECT_EQ(last.reason, "the device was lost in W02");
    EXPECT_TRUE(state.cases.contains("W02")) << "or --resume runs into it again";
}

TEST_F(SuiteRun, MeasuresEveryAbleConfigurationAndListsTheOthers) {
    if (!can_run_) return;
    const std::vector<Record> records = run({make_case("W01", sound)});
    std::size_t configurations = 0;
    for (const Record& record : records) {
        if (!record.was_run) {
            EXPECT_FALSE(record.reason.empty());
            continue;
        }
        ++configurations;
        EXPECT_EQ(record.n, 500u);
        ASSERT_TRUE(record.time && record.error);
        EXPECT_EQ(record.time->reps, 3u);
        EXPECT_GT(record.time->median, 0);
        EXPECT_TRUE(record.time->phases_ms.contains("build"));
    }
    EXPECT_GE(configurations, 2u);
    EXPECT_EQ(report::faults_of_ours(records), 0u);
}

TEST_F(SuiteRun, LeaksOfOursAndOfTheDriverAreToldApart) {
    if (!can_run_) return;
    const test::TempDir folder;
    const std::vector<Record> records =
        run({make_case("W01", [](CaseRun& here) { here.measure(world_with_holes(), rays()); })},
            {.levels = {Level::fast, Level::watertight}, .replays_in = folder / "report"});
    std::size_t ours = 0;
    for (const Record& record : records) {
        if (!record.was_run || record.level != "watertight") continue;
        EXPECT_EQ(record.pass, false);
        EXPECT_EQ(record.fault_of, record.backend == "sw" ? "twinray" : "driver");
        EXPECT_GT(record.counts.at(record.backend == "sw" ? "SW_LEAK" : "HW_LEAK"), 0u);
        EXPECT_FALSE(record.example.empty());
        const std::filesystem::path file = folder / "report" / record.replay;
        const replay::Replay replay = replay::read(file);
        EXPECT_EQ(record.example, replay.kind + ' ' + hexadecimal(replay.ray));
        EXPECT_EQ(replay.backend + replay.level, record.backend + record.level);
        EXPECT_EQ(replay::hash_of(load_scene(file.parent_path() / replay.scene)), replay.scene_hash);
        if (record.backend == "sw") ++ours;
    }
    EXPECT_EQ(ours, 1u);
    EXPECT_EQ(report::faults_of_ours(records), 1u);
}

TEST_F(SuiteRun, AControlThatShowsNothingIsAFaultOfOurs) {
    if (!can_run_) return;
    const Settings software{.backends = {Backend::software}, .levels = {Level::watertight, Level::fast}};
    Control control = without_precise();
    control.must_show = true;
    const auto measure = [&](const World& world) {
        return run({make_case("W01", [&](CaseRun& here) { here.measure(world, rays(), {.control = control}); })},
                   software);
    };
    const std::vector<Record> shown = measure(world_with_holes()), hidden = measure(world_of(make_icosphere(3)));
    ASSERT_TRUE(shown.size() == 1 && hidden.size() == 1);
    EXPECT_EQ(shown[0].variant, "control: without precise");
    EXPECT_EQ(shown[0].pass, true);
    EXPECT_EQ(hidden[0].pass, false);
    EXPECT_EQ(hidden[0].fault_of, "twinray");
    const auto fast = [&](const World& world) {
        const Settings only_fast{.backends = {Backend::software}, .levels = {Level::fast}};
        return run({make_case("W01", [&](CaseRun& here) { here.measure(world, rays(), {.fast_is_control = true}); })},
                   only_fast);
    };
    EXPECT_EQ(fast(world_with_holes())[0].pass, true);
    EXPECT_EQ(fast(world_of(make_icosphere(3)))[0].pass, false);
}

TEST_F(SuiteRun, ACaseThatThrowsIsRecordedAndTheRestGoesOn) {
    if (!can_run_) return;
    const std::vector<Record> records =
        run({make_case("W01", [](CaseRun&) { fail("broken"); }), make_case("W03", sound)});
    ASSERT_GE(records.size(), 2u);
    EXPECT_EQ(records[0].reason, "broken");
    EXPECT_EQ(records[0].fault_of, "twinray");
    EXPECT_TRUE(std::any_of(records.begin(), records.end(),
                            [](const Record& r) { return r.case_id == "W03" && r.pass.value_or(false); }));
    EXPECT_EQ(report::faults_of_ours(records), 1u);
}

TEST_F(SuiteRun, OnlyWhatIsAskedForRuns) {
    if (!can_run_) return;
    const Settings settings{.backends = {Backend::software}, .levels = {Level::watertight}, .only = {"W0?"}};
    const std::vector<Record> records = run({make_case("W01", sound), make_case("S02", sound)}, settings);
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].case_id + records[0].backend + records[0].level, "W01swwatertight");
}

TEST_F(SuiteRun, WhatIsLeftOfTheTimeGoesToWhatIsLeastCertain) {
    if (!can_run_) return;
    const auto amounts = [](std::size_t full) {
        return [full](CaseRun& here) { here.expect({}, {.n = here.amount(10, full)}); };
    };
    const std::vector<Record> records =
        run({make_case("W01", amounts(100'000)), make_case("S01", amounts(10))}, {.seconds = 30});
    ASSERT_EQ(records.size(), 2u) << "a later run takes the place of an earlier one";
    for (const Record& record : records) EXPECT_EQ(record.n, record.case_id == "W01" ? 100'000u : 10u);
}

TEST_F(SuiteRun, WhatIsDoneIsNotDoneAgain) {
    if (!can_run_) return;
    Recorder recorder({"now", "0.1", {}});
    SuiteState state{.cases = {{"W01", {}}}};
    suite::run(std::vector{make_case("W01", sound), make_case("S02", sound)}, {}, *devices_, recorder, state, true);
    for (const Record& record : recorder.records()) EXPECT_EQ(record.case_id, "S02");
    EXPECT_TRUE(state.cases.contains("S02"));
}

TEST_F(SuiteRun, EveryCaseRunsHoweverShortTheTime) {
    if (!can_run_) return;
    for (const double seconds : {0.0, 1e-9}) {
        const std::vector<Record> records =
            run({make_case("W01", sound), make_case("S02", sound)}, {.seconds = seconds});
        for (const char* id : {"W01", "S02"})
            EXPECT_TRUE(std::ranges::any_of(records, [&](const Record& record) {
                return record.case_id == id && record.was_run;
            })) << id;
    }
}

TEST_F(SuiteRun, ACaseThatAsksWhatTheTableOfClaimsDoesNotSayIsAFault) {
    if (!can_run_) return;
    const std::vector<Record> records = run({make_case("D01", sound)});
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].fault_of, "twinray");
    EXPECT_NE(records[0].reason.find("claims"), std::string::npos) << records[0].reason;
}

}  // namespace
}  // namespace twinray::suite
