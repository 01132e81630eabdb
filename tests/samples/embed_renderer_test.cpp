// SPDX-License-Identifier: MIT
// A renderer with a Vulkan of its own, whose shadows twinray traces: the validation layer listens throughout.
#include "samples/embed_renderer/report.h"

#include <gtest/gtest.h>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "tests/support/device.h"

namespace twinray::embed_renderer {
namespace {

constexpr uint width = 160, height = 120, pixel_count = width * height;

Scene tower() {
    Scene scene;
    scene.materials.push_back({.name = "white", .metallic = 0});
    scene.meshes.push_back(make_box(vec3(-0.3f, 0, -0.3f), vec3(0.3f, 1.2f, 0.3f)));
    scene.instances.push_back({"tower", 0, Transform{}});
    return scene;
}

Options small(const char* accel) {
    Options options;
    options.accel = accel;
    options.width = width;
    options.height = height;
    options.balls = 12;
    return options;
}

class EmbedRenderer : public ::testing::Test {
  protected:
    void SetUp() override {
        const std::unique_ptr<Context> context = test::make_context();
        if (!context) TWINRAY_LACKS("vulkan", "no usable device");
        has_pipeline_ = context->properties().ray_tracing_pipeline;
        has_hardware_ = missing_for_hardware(context->properties()).empty();
    }
    // One frame for each of `turns`.
    std::vector<FrameResult> render(const Options& options, const std::vector<float>& turns,
                                    bool use_ray_query = true) {
        const Stage stage = make_stage(tower(), options.balls, true);
        const Device device({.validation = true, .use_ray_query = use_ray_query, .log = [](std::string_view message) {
                                 ADD_FAILURE() << message;
                             }});
        std::vector<FrameResult> frames;
        {
            Renderer renderer(device, stage, options);
            for (const float turn : turns) frames.push_back(renderer.render(turn));
        }
        EXPECT_EQ(device.live_allocations(), 0u) << "twinray's buffers are the host's, too";
        EXPECT_EQ(device.validation_message_count(), 0u);
        return frames;
    }
    bool has_hardware_ = false, has_pipeline_ = false;
};

float light(const FrameResult& frame, std::size_t pixel) { return path_tracer::luminance(frame.picture.rgb[pixel]); }

template <class Predicate>
uint count_pixels(const Predicate& holds) {
    uint count = 0;
    for (std::size_t i = 0; i < pixel_count; ++i) count += holds(i);
    return count;
}

uint differing(const FrameResult& a, const FrameResult& b) {
    return count_pixels([&](std::size_t i) { return a.picture.rgb[i] != b.picture.rgb[i]; });
}

// Rays on which the accelerators may disagree graze an edge: each changes one pixel.
TEST_F(EmbedRenderer, BothAcceleratorsShowTheSame) {
    if (!has_hardware_) TWINRAY_LACKS("ray_tracing", "no ray tracing extensions");
    const std::vector<FrameResult> software = render(small("sw"), {0, 0.1f, 0.2f});
    const std::vector<FrameResult> hardware = render(small("hw"), {0, 0.1f, 0.2f});
    for (std::size_t i = 0; i < software.size(); ++i) {
        EXPECT_LE(differing(software[i], hardware[i]), 10u) << "of " << pixel_count << " in frame " << i;
        EXPECT_EQ(software[i].rays.shadow, hardware[i].rays.shadow);
    }
    EXPECT_EQ(software[0].laps.size(), 7u);
}

// On devices without ray queries the traces run in another stage of the GPU.
TEST_F(EmbedRenderer, ARayTracingPipelineShowsTheSame) {
    if (!has_pipeline_) TWINRAY_LACKS("ray_tracing", "no ray tracing pipelines");
    const std::vector<FrameResult> software = render(small("sw"), {0, 0.1f});
    const std::vector<FrameResult> pipeline = render(small("hw"), {0, 0.1f}, false);
    for (std::size_t i = 0; i < software.size(); ++i) EXPECT_LE(differing(software[i], pipeline[i]), 10u);
}

TEST_F(EmbedRenderer, ANumberIsTheIndexOfADeviceAndNoPartOfAName) {
    const std::string beyond = std::to_string(list_devices().size());
    try {
        const Device device({.device = beyond});
        ADD_FAILURE() << "there is no device " << beyond;
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("does not match the request '" + beyond + "'"), std::string::npos)
            << error.what();
    }
}

class EmbedRendererBy : public EmbedRenderer, public ::testing::WithParamInterface<const char*> {
  protected:
    void SetUp() override {
        EmbedRenderer::SetUp();
        if (!IsSkipped() && std::string(GetParam()) == "hw" && !has_hardware_)
            TWINRAY_LACKS("ray_tracing", "no ray tracing extensions");
    }
};
INSTANTIATE_TEST_SUITE_P(EveryAccel, EmbedRendererBy, ::testing::Values("sw", "hw"),
                         [](const auto& which) { return std::string(which.param); });

TEST_P(EmbedRendererBy, ShadowsDarkenAndNothingGetsBrighter) {
    Options options = small(GetParam());
    options.sun_angle = 0;
    options.ao_rays = 0;
    const FrameResult shadowed = render(options, {0}).front();
    options.shadow_rays = 0;
    const FrameResult lit = render(options, {0}).front();
    EXPECT_EQ(lit.rays.shadow, 0u);
    EXPECT_EQ(shadowed.rays.ao, 0u);
    EXPECT_EQ(count_pixels([&](std::size_t i) { return light(shadowed, i) > light(lit, i); }), 0u);
    // The tower's shadow on the ground, about as large as what is seen of the tower, and small ones.
    const uint darker = count_pixels([&](std::size_t i) { return light(shadowed, i) < 0.5f * light(lit, i); });
    EXPECT_GT(darker, pixel_count / 50);
    EXPECT_LT(darker, pixel_count / 5);
}

// A surface that shadows itself is speckled: with a hard sun each pixel is lit or not, and lone ones are rare.
TEST_P(EmbedRendererBy, SurfacesDoNotShadowThemselves) {
    Options options = small(GetParam());
    options.sun_angle = 0;
    options.ao_rays = 0;
    const FrameResult shadowed = render(options, {0}).front();
    options.shadow_rays = 0;
    const FrameResult lit = render(options, {0}).front();
    const auto is_dark = [&](std::size_t i) { return light(shadowed, i) < 0.9f * light(lit, i); };
    const uint lone = count_pixels([&](std::size_t i) {
        const std::size_t x = i % width, y = i / width;
        if (x == 0 || y == 0 || x + 1 == width || y + 1 == height || !is_dark(i)) return false;
        return !is_dark(i - 1) && !is_dark(i + 1) && !is_dark(i - width) && !is_dark(i + width);
    });
    EXPECT_LE(lone, 3u);
}

TEST_P(EmbedRendererBy, OcclusionDarkensWhereSurfacesMeet) {
    Options options = small(GetParam());
    options.shadow_rays = 0;
    options.ao_rays = 16;
    const FrameResult occluded = render(options, {0}).front();
    options.ao_rays = 0;
    const FrameResult open = render(options, {0}).front();
    EXPECT_EQ(count_pixels([&](std::size_t i) { return light(occluded, i) > light(open, i); }), 0u);
    const uint darker = count_pixels([&](std::size_t i) { return light(occluded, i) < 0.98f * light(open, i); });
    EXPECT_GT(darker, pixel_count / 100);
    EXPECT_LT(darker, pixel_count / 3) << "most of the ground is far from everything";
}

// The ground at a pixel where no ball is in either frame changes only if the accelerator has moved the balls.
TEST_P(EmbedRendererBy, BallsAndTheirShadowsMove) {
    Options options = small(GetParam());
    options.sun_angle = 0;
    options.ao_rays = 0;
    const std::vector<FrameResult> shadowed = render(options, {0, 0.05f, 0.1f, 0.05f});
    options.shadow_rays = 0;
    const std::vector<FrameResult> lit = render(options, {0, 0.05f, 0.1f, 0.05f});
    EXPECT_EQ(differing(shadowed[1], shadowed[3]), 0u) << "the same place, the same picture";
    for (std::size_t frame = 1; frame < 3; ++frame) {
        EXPECT_GT(differing(lit[frame - 1], lit[frame]), 100u) << "balls";
        const uint shadows = count_pixels([&](std::size_t i) {
            const bool is_ground = lit[frame - 1].picture.rgb[i] == lit[frame].picture.rgb[i];
            return is_ground && shadowed[frame - 1].picture.rgb[i] != shadowed[frame].picture.rgb[i];
        });
        EXPECT_GT(shadows, 20u) << "their shadows in frame " << frame;
    }
}

TEST(EmbedRendererCosts, AreMediansWithoutTheFirstFrame) {
    const Costs costs = costs_of({{{"raster", 99}, {"sync", 99}},
                                  {{"raster", 3}, {"sync", 1}},
                                  {{"raster", 5}, {"sync", 7}},
                                  {{"raster", 4}, {"sync", 1}}});
    ASSERT_EQ(costs.passes.size(), 2u);
    EXPECT_EQ(costs.passes[0].ms, 4);
    EXPECT_FALSE(costs.passes[0].is_twinrays);
    EXPECT_TRUE(costs.passes[1].is_twinrays);
    EXPECT_EQ(costs.frame_ms, 5);
    EXPECT_EQ(costs.twinray_ms, 1);
    EXPECT_EQ(costs.twinray_percent(), 20);
}

}  // namespace
}  // namespace twinray::embed_renderer
