// The suite's runner on a device, and cases that count crossings.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/core/error.h"
#include "report/page/verdict.h"
#include "report/replay/replay.h"
#include "report/suite/scenes.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"
#include "validation/leaks/closed_mesh.h"

namespace twinray::suite {
namespace {

class SuiteRun : public ::testing::Test {
  protected:
    void SetUp() override {
        if (test::make_context())
            devices_ = std::make_unique<Devices>(ContextDesc{.validation = test::has_validation()});
        else if (HasFailure())
            FAIL() << "no device";  // which ends the test
    }
    std::vector<Record> run(const std::vector<SuiteCase>& cases, const Settings& settings = {}) {
        Recorder recorder({"now", "0.1", {}});
        SuiteState state;
        suite::run(cases, settings, *devices_, recorder, state, true);
        EXPECT_TRUE(devices_->context(Backend::software).validation_messages().empty());
        return recorder.records();
    }
    std::unique_ptr<Devices> devices_;
};

SuiteCase make_case(const char* id, std::function<void(CaseRun&)> run) {
    return {id, "title", "measures", "criterion", std::move(run)};
}

// Makes a world that is traced without the triangles that `is_hole` names, so that a reference of the whole finds
// leaks.
template <class IsHole>
World world_with_holes(Mesh mesh, const IsHole& is_hole) {
    World world = world_of(mesh);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (is_hole(i)) mesh.triangles[i] = uvec3(0);
    world.fill = [mesh](AbstractAccel& accel) { accel.push(mesh); };
    return world;
}
World world_with_holes() {
    return world_with_holes(make_icosphere(3), [](std::size_t i) { return i % 2 == 0; });
}

std::vector<Ray> rays() { return random_rays({vec3(-1), vec3(1)}, 500, 1); }

const std::function<void(CaseRun&)> sound = [](CaseRun& run) { run.measure(world_of(make_icosphere(3)), rays()); };

// If the same computation on the answers of both is right with SwTlas, a fault is the driver's.
TEST_F(SuiteRun, WhatIsRightBySoftwareIsTheDriversFault) {
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
    const Settings settings{.backends = {Backend::software}, .levels = {Level::watertight}, .only = {"W0?"}};
    const std::vector<Record> records = run({make_case("W01", sound), make_case("S02", sound)}, settings);
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].case_id + records[0].backend + records[0].level, "W01swwatertight");
}

TEST_F(SuiteRun, WhatIsLeftOfTheTimeGoesToWhatIsLeastCertain) {
    const auto amounts = [](std::size_t full) {
        return [full](CaseRun& here) { here.expect({}, {.n = here.amount(10, full)}); };
    };
    const std::vector<Record> records =
        run({make_case("W01", amounts(100'000)), make_case("S01", amounts(10))}, {.seconds = 30});
    ASSERT_EQ(records.size(), 2u) << "a later run takes the place of an earlier one";
    for (const Record& record : records) EXPECT_EQ(record.n, record.case_id == "W01" ? 100'000u : 10u);
}

TEST_F(SuiteRun, WhatIsDoneIsNotDoneAgain) {
    Recorder recorder({"now", "0.1", {}});
    SuiteState state{.cases = {{"W01", {}}}};
    suite::run(std::vector{make_case("W01", sound), make_case("S02", sound)}, {}, *devices_, recorder, state, true);
    for (const Record& record : recorder.records()) EXPECT_EQ(record.case_id, "S02");
    EXPECT_TRUE(state.cases.contains("S02"));
}

TEST_F(SuiteRun, EveryCaseRunsHoweverShortTheTime) {
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
    const std::vector<Record> records = run({make_case("D01", sound)});
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].fault_of, "twinray");
    EXPECT_NE(records[0].reason.find("claims"), std::string::npos) << records[0].reason;
}

class CrossingsTest : public SuiteRun {
  protected:
    void SetUp() override {
        SuiteRun::SetUp();
        if (!devices_) return;  // skipped
        for (const Configuration configuration : {Configuration{Backend::software, Level::fast},
                                                  {Backend::software, Level::watertight},
                                                  {Backend::software, Level::refined},
                                                  {Backend::ray_query, Level::watertight},
                                                  {Backend::ray_query, Level::refined}})
            if (devices_->why_not(configuration).empty()) configurations_.push_back(configuration);
    }
    std::vector<uint> count(const Configuration& configuration, const World& world, std::span<const Ray> rays) {
        return crossings_of(*devices_, configuration, world, rays);
    }
    std::vector<Record> run(const std::function<void(CaseRun&)>& body) {
        return SuiteRun::run({make_case("W02", body)}, {.levels = {Level::fast, Level::watertight}});
    }
    std::vector<Configuration> configurations_;  // none without a device
};

// Returns walls at z = 0, 1, ..., 11, two copies of each in two instances.
World twelve_double_walls() {
    Mesh walls;
    for (uint i = 0; i < 12; ++i) append(walls, make_quad(vec3(-1, -1, i), vec3(2, 0, 0), vec3(0, 2, 0)));
    World world = world_of(walls);
    world.fill = [walls](AbstractAccel& accel) {
        const std::vector<Transform> twice(2);
        accel.push(walls, twice, std::vector<InstanceOptions>(2, {.non_opaque = true}));
    };
    return world;
}

TEST_F(CrossingsTest, EveryTriangleWithinTheIntervalCounts) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const Ray rays[] = {{{0.1f, 0.2f, -1}, 0, {0, 0, 1}, inf},     // all
                        {{0.1f, 0.2f, -1}, 0, {0, 0, 1}, 3.5f},    // z = 0, 1, 2
                        {{0.1f, 0.2f, -1}, 2.5f, {0, 0, 2}, inf},  // from beyond z = 4 on
                        {{0.1f, 0.2f, 20}, 0, {0, 0, 1}, inf},     // away
                        {{0.1f, 0.2f, 5.5f}, 0, {0, 0, -1}, inf},  // z = 5 to 0
                        {{3, 0.2f, -1}, 0, {0, 0, 1}, inf}};       // beside
    const std::vector<uint> expected = {24, 6, 14, 0, 12, 0};
    for (const Configuration& configuration : configurations_)
        EXPECT_EQ(count(configuration, twelve_double_walls(), rays), expected)
            << name_of(configuration.backend) << name_of(configuration.level);
}

TEST_F(CrossingsTest, AMissingTriangleIsALeakOfItsBackend) {
    const Mesh sphere = make_icosphere(2);
    const ClosedMesh closed(sphere);
    const std::vector<Ray> rays = InsideRays(closed, Aim::edges, 1).rays(0, 2'000);
    Mesh holed = sphere;
    holed.triangles[7] = uvec3(0);
    const auto count_on = [&](const Mesh& mesh, bool fast_is_control) {
        return run([&](CaseRun& here) {
            here.count_crossings(world_of(mesh, {}, {.non_opaque = true}), rays,
                                 [](const Ray&, uint count) { return count == 1; },
                                 {.fast_is_control = fast_is_control});
        });
    };
    for (const Record& record : count_on(holed, false)) {
        if (!record.was_run || record.level == "fast") continue;
        EXPECT_EQ(record.pass, false);
        EXPECT_EQ(record.fault_of, record.backend == "sw" ? "twinray" : "driver");
        EXPECT_GT(record.counts.at("CROSSED_0"), 0u);
        EXPECT_EQ(record.counts.at("AGREE") + record.faults, 2'000u);
        if (record.backend == "sw") {
            EXPECT_EQ(record.example.substr(0, 16), "crossed 0 times ");
        }
    }
    for (const Record& record : count_on(sphere, true)) {
        if (record.backend != "sw" || !record.was_run) continue;
        EXPECT_EQ(record.pass, true) << record.level << " " << record.faults;
        EXPECT_EQ(record.level == "fast", record.faults > 0);
    }
}

// A known kernel loses some of 512 rays.
TEST_F(CrossingsTest, AControlMustShowMoreThanItsRate) {
    const World world = world_with_holes(make_icosphere(2), [](std::size_t i) { return i < 32; });  // 32 of 320
    const ClosedMesh closed(make_icosphere(2));
    const std::vector<Ray> rays = InsideRays(closed, Aim::edges, 1).rays(0, 512);
    const auto passes = [&](double least_rate) {
        Control control = without_precise();
        control.must_show = true;
        control.least_rate = least_rate;
        return run([&](CaseRun& here) { here.measure(world, rays, {.control = control}); }).at(0).pass.value();
    };
    EXPECT_TRUE(passes(0.01));
    EXPECT_FALSE(passes(0.5));
}

}  // namespace
}  // namespace twinray::suite
