// Particles: the kernel moves and colours them as its serial reference does, and the host never waits for a frame.
#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include <twinray/tlas.h>
#include "samples/particles/particles.h"
#include "tests/support/device.h"
#include "report/faults/fault_injection.h"

namespace twinray::particles {
namespace {

void expect_color(vec3 color, vec3 expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected[i], 1e-6f) << i;
}

TEST(ParticleColors, AreThoseOfTheHeatMap) {
    const vec3 eighths[] = {{0.1f, 0.2f, 0.8f}, {0.1f, 0.45f, 0.8f}, {0.1f, 0.7f, 0.8f},
                            {0.4f, 0.7f, 0.5f}, {0.7f, 0.7f, 0.2f},  {0.85f, 0.5f, 0.15f},
                            {1, 0.3f, 0.1f},    {1, 0.65f, 0.55f},   {1, 1, 1}};
    for (int i = 0; i <= 8; ++i) expect_color(heat_color(static_cast<float>(i) / 8), eighths[i]);
    for (const float edge : {0.25f, 0.5f, 0.75f})
        expect_color(heat_color(std::nextafter(edge, 0.0f)), heat_color(edge));
    const HeatMaterial material = heat_material(4, vec3(0, 3, 4), 10);
    expect_color(material.color, heat_color(0.5f));
    const float noise = 0.5f * std::sin(0.5f) + 0.5f;  // of the fifth
    EXPECT_NEAR(material.metallic, 0.3f + 0.6f * noise, 1e-6f);
    EXPECT_NEAR(material.roughness, 0.2f + 0.4f * (1 - noise), 1e-6f);
    expect_color(heat_material(0, vec3(100, 0, 0), 10).color, {1, 1, 1});
}

TEST(ParticleMotion, WallsThrowBack) {
    const Motion free = moved({0, 1}, 0.1f, -2, 0.5f, 0.5f);
    EXPECT_EQ(free.velocity, 0.0f);
    EXPECT_EQ(free.position, 0.0f);
    const Motion bounced = moved({0.75f, 1}, 0.125f, 0, 0.25f, 0.5f);
    EXPECT_EQ(bounced.position, 0.875f - 0.5f * 0.125f);
    EXPECT_EQ(bounced.velocity, -0.5f);
    EXPECT_EQ(moved({-0.5f, -1000}, 0.125f, 0, 1, 1).position, 0.875f) << "thrown beyond the other wall";
}

// Computes what the kernel does in one frame.
void step_reference(Motions& particles, std::vector<HeatMaterial>& materials) {
    for (std::size_t i = 0; i < particles.radii.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            Motion motion{particles.positions[i][axis], particles.velocities[i][axis]};
            motion = moved(motion, particles.radii[i], axis == 1 ? -gravity : 0, seconds_per_frame, bounce);
            particles.positions[i][axis] = motion.position;
            particles.velocities[i][axis] = motion.velocity;
        }
        materials[i] = heat_material(static_cast<uint>(i), particles.velocities[i], max_speed);
    }
}

class ParticlesBy : public test::VulkanTest, public ::testing::WithParamInterface<const char*> {
  protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && std::string(GetParam()) != "sw" &&
            !missing_for_hardware(context().properties()).empty())
            TWINRAY_LACKS("ray_tracing", "no ray tracing extensions");
    }
    ContextDesc context_desc() const override { return {.get_instance_proc_addr = injector_.entry()}; }
    std::unique_ptr<AbstractAccel> make_accel(const std::string& kind) {
        if (kind == "hw") return std::make_unique<HwTlas>(context());
        return std::make_unique<SwTlas>(context());
    }
    // Returns the picture after this many frames.
    HdrImage picture_of(const std::string& kind, const Motions& start, uint frames) {
        const std::unique_ptr<AbstractAccel> accel = make_accel(kind);
        Simulation simulation(*accel, start);
        Renderer renderer(simulation, {.width = 80, .height = 60});
        for (uint frame = 0; frame < frames; ++frame) {
            simulation.step();
            renderer.draw();
        }
        return renderer.picture();
    }
    faults::FaultInjector injector_;
};
INSTANTIATE_TEST_SUITE_P(EveryAccel, ParticlesBy, ::testing::Values("sw", "hw"),
                         [](const auto& which) { return std::string(which.param); });

TEST_P(ParticlesBy, TheKernelMovesAndColoursAsItsReference) {
    Motions reference = make_particles(200, 3);
    std::vector<HeatMaterial> materials(reference.radii.size());
    const std::unique_ptr<AbstractAccel> accel = make_accel(GetParam());
    Simulation simulation(*accel, reference);
    for (int frame = 0; frame < 60; ++frame) {
        simulation.step();
        step_reference(reference, materials);
    }
    const std::vector<vec3> positions = simulation.particles().download(&Particles::position);
    const std::vector<vec3> velocities = simulation.particles().download(&Particles::velocity);
    const std::vector<HeatMaterial> colored = simulation.materials().download<HeatMaterial>();
    const std::vector<InstanceState> instances = accel->get_instances(simulation.balls());
    ASSERT_EQ(colored.size(), materials.size());
    int bounced = 0;
    const Motions start = make_particles(200, 3);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        EXPECT_EQ(positions[i], reference.positions[i]) << i;
        EXPECT_EQ(velocities[i], reference.velocities[i]) << i;
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(colored[i].color[k], materials[i].color[k], 1e-5f) << i;
        EXPECT_NEAR(colored[i].metallic, materials[i].metallic, 1e-5f) << i;
        EXPECT_NEAR(colored[i].roughness, materials[i].roughness, 1e-5f) << i;
        EXPECT_EQ(transform_point(instances[i].transform, vec3(0)), positions[i]) << i;
        EXPECT_EQ(transform_vector(instances[i].transform, vec3(1)), vec3(reference.radii[i])) << i;
        bounced += velocities[i].x * start.velocities[i].x < 0;
    }
    EXPECT_GT(bounced, 10) << "too few met a wall to show anything";
    EXPECT_LE(accel->world_bound().hi.x, 1.001f);
}

TEST_P(ParticlesBy, ColoursOfTheSpeedReachThePicture) {
    const auto center_of_ball = [&](vec3 velocity) {
        const Motions one{{vec3(0, 0, 0.5f)}, {velocity}, {0.3f}};
        return picture_of(GetParam(), one, 1).rgb[30 * 80 + 40];
    };
    const vec3 slow = center_of_ball({}), fast = center_of_ball({max_speed, 0, 0});
    EXPECT_GT(slow.z, 3 * slow.x);
    EXPECT_GT(slow.z, 2 * slow.y);
    EXPECT_NEAR(fast.x, fast.z, 0.02f * fast.x) << "white, but for what gravity slowed";
    EXPECT_GT(fast.x, 3 * slow.x);
}

TEST_P(ParticlesBy, TheHostNeverWaitsForAFrame) {
    const std::unique_ptr<AbstractAccel> accel = make_accel(GetParam());
    Simulation simulation(*accel, make_particles(1000, 1));
    Renderer renderer(simulation, {.width = 32, .height = 24});
    simulation.step();
    renderer.draw();
    accel->wait_for_programs();
    context().wait_for_gpu();
    const std::uint64_t revision = accel->revision();
    const SyncPoint start = context().last_submission();
    injector_.inject({.function = "vkWaitSemaphores", .first = faults::every_call});
    for (int frame = 0; frame < 100; ++frame) {
        simulation.step();
        renderer.draw();
    }
    EXPECT_EQ(injector_.calls(), 0u);
    EXPECT_EQ(context().last_submission().value, start.value + 300) << "move, sync, picture";
    EXPECT_EQ(accel->revision(), revision) << "refits change no addresses";
    context().wait_for_gpu();
    EXPECT_EQ(injector_.calls(), 1u) << "the wait above was counted";
}

class ParticlesByBoth : public ParticlesBy {};
INSTANTIATE_TEST_SUITE_P(Once, ParticlesByBoth, ::testing::Values("both"));

TEST_P(ParticlesByBoth, ThePicturesAreTheSame) {
    const Motions start = make_particles(300, 5);
    const HdrImage software = picture_of("sw", start, 10), hardware = picture_of("hw", start, 10);
    int differing = 0, lit = 0;
    for (std::size_t i = 0; i < software.rgb.size(); ++i) {
        lit += software.rgb[i].y > 0.1f;
        const vec3 difference = abs(software.rgb[i] - hardware.rgb[i]);
        differing += std::max({difference.x, difference.y, difference.z}) > 0.01f;
    }
    EXPECT_LE(differing, 4) << "of " << software.rgb.size()
                            << ": rays that graze an edge; others are hit at points a rounding apart";
    EXPECT_GT(lit, 1000);
}

}  // namespace
}  // namespace twinray::particles
