// SPDX-License-Identifier: MIT
// Counting crossings, on a device.
#include <gtest/gtest.h>

#include <twinray/scene.h>

#include "report/suite/case_run.h"
#include <twinray/geometry.h>
#include "validation/leaks/inside_rays.h"
#include "report/suite/shapes.h"
#include "tests/support/device.h"

namespace twinray::suite {
namespace {

class CrossingsTest : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!test::make_context()) return;
        devices_ = std::make_unique<Devices>(ContextDesc{.validation = true});
        for (const Configuration configuration : {Configuration{Backend::software, Level::fast},
                                                  {Backend::software, Level::watertight},
                                                  {Backend::software, Level::refined},
                                                  {Backend::ray_query, Level::watertight},
                                                  {Backend::ray_query, Level::refined}})
            if (devices_->why_not(configuration).empty()) configurations_.push_back(configuration);
    }
    std::vector<uint> count(const Configuration& configuration, const World& world, std::span<const Ray> rays) {
        AbstractAccel& accel = devices_->empty_accel(configuration);
        world.fill(accel);
        accel.sync();
        return devices_->crossing_counter(configuration).count(accel, rays);
    }
    std::vector<Record> run(const std::function<void(CaseRun&)>& body) {
        const SuiteCase row{"W02", "title", "measures", "criterion", body};
        Recorder recorder({"now", "0.1", {}});
        SuiteState state;
        suite::run(std::span(&row, 1), {.levels = {Level::fast, Level::watertight}}, *devices_, recorder, state, true);
        return recorder.records();
    }
    std::unique_ptr<Devices> devices_;
    std::vector<Configuration> configurations_;  // none without a device
};

// Walls at z = 0, 1, ..., 11, two copies of each in two instances.
World twelve_double_walls() {
    Scene scene;
    Mesh walls;
    for (uint i = 0; i < 12; ++i) {
        const Mesh wall = make_quad(vec3(-1, -1, i), vec3(2, 0, 0), vec3(0, 2, 0));
        for (const uvec3& triangle : wall.triangles)
            walls.triangles.push_back(triangle + static_cast<uint>(walls.positions.size()));
        walls.positions.insert(walls.positions.end(), wall.positions.begin(), wall.positions.end());
    }
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
    if (configurations_.empty()) return;
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

// Of 512 rays, a known kernel loses some.
TEST_F(CrossingsTest, AControlMustShowMoreThanItsRate) {
    if (configurations_.empty()) return;
    Mesh holed = make_icosphere(2);
    for (std::size_t i = 0; i < 32; ++i) holed.triangles[i] = uvec3(0);  // of 320
    World world = world_of(make_icosphere(2));
    world.fill = [holed](AbstractAccel& accel) { accel.push(holed); };
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
