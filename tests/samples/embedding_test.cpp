// The renderer of tutorial 6, for which twinray traces shadows: the pictures that its users look at.
#include <gtest/gtest.h>

#include "samples/tutorials/06_embedding/renderer.h"
#include "samples/tutorials/06_embedding/shadows.h"
#include "tests/support/device.h"

namespace renderer {
namespace {

using Picture = std::vector<twinray::Rgb>;
constexpr VkExtent2D size{210, 180};

struct Frames {
    Picture plain, shadowed;
};

float light(const twinray::Rgb& pixel) { return static_cast<float>(pixel.r + pixel.g + pixel.b); }

template <class Predicate>
std::size_t count_pixels(const Predicate& holds) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::size_t{size.width} * size.height; ++i) count += holds(i);
    return count;
}

std::size_t differing(const Picture& a, const Picture& b) {
    return count_pixels([&](std::size_t i) { return a[i] != b[i]; });
}

class Embedding : public ::testing::Test {
  protected:
    void SetUp() override {
        const std::unique_ptr<twinray::Context> context = twinray::test::make_context();
        if (!context) TWINRAY_LACKS("vulkan", "no usable device");
        has_hardware_ = twinray::missing_for_hardware(context->properties()).empty();
        has_pipeline_ = context->properties().ray_tracing_pipeline;
    }
    // Renders a frame for each turn of the ring, without shadows and with those of `accel`.
    static std::vector<Frames> render(const std::string& accel, const std::vector<float>& turns,
                                      RayTracing ray_tracing = RayTracing::if_there) {
        const Device device(ray_tracing);
        Scene scene = make_scene(device);
        Renderer renderer(device, scene, size);
        Shadows shadows(device, scene, size, accel);
        std::vector<Frames> frames;
        for (const float turn : turns) {
            turn_ring(scene, turn);
            const Picture plain = renderer.picture(renderer.submit(scene, nullptr));
            shadows.move(scene);
            frames.push_back({plain, renderer.picture(renderer.submit(scene, &shadows))});
        }
        return frames;
    }
    bool has_hardware_ = false, has_pipeline_ = false;
};

// The accelerators may only disagree on rays that graze an edge: each changes one pixel. On devices without ray queries
// the traces run in another stage of the GPU.
TEST_F(Embedding, BothAcceleratorsShowTheSameWhileThingsMove) {
    const std::vector<float> turns = {0, 0.1f, 0.2f};
    const std::vector<Frames> software = render("sw", turns);
    for (const RayTracing ray_tracing : {RayTracing::if_there, RayTracing::pipelines}) {
        if (ray_tracing == RayTracing::pipelines ? !has_pipeline_ : !has_hardware_)
            TWINRAY_LACKS("ray_tracing", "no ray tracing");
        const std::vector<Frames> hardware = render("hw", turns, ray_tracing);
        for (std::size_t i = 0; i < software.size(); ++i)
            EXPECT_LE(differing(software[i].shadowed, hardware[i].shadowed), 10u) << "in frame " << i;
    }
}

class EmbeddingBy : public Embedding, public ::testing::WithParamInterface<const char*> {
  protected:
    void SetUp() override {
        Embedding::SetUp();
        if (!IsSkipped() && std::string(GetParam()) == "hw" && !has_hardware_)
            TWINRAY_LACKS("ray_tracing", "no ray tracing extensions");
    }
};
INSTANTIATE_TEST_SUITE_P(EveryAccel, EmbeddingBy, ::testing::Values("sw", "hw"),
                         [](const auto& which) { return std::string(which.param); });

TEST_P(EmbeddingBy, ShadowsDarkenAndNothingGetsBrighter) {
    const Frames frames = render(GetParam(), {0}).front();
    EXPECT_EQ(count_pixels([&](std::size_t i) { return light(frames.shadowed[i]) > light(frames.plain[i]); }), 0u);
    const std::size_t darker =
        count_pixels([&](std::size_t i) { return light(frames.shadowed[i]) < 0.7f * light(frames.plain[i]); });
    EXPECT_GT(darker, count_pixels([](std::size_t) { return true; }) / 50);
    EXPECT_LT(darker, count_pixels([](std::size_t) { return true; }) / 3);
}

// A surface that shadows itself is speckled: the sun is hard, and lone pixels without it are rare.
TEST_P(EmbeddingBy, SurfacesDoNotShadowThemselves) {
    const Frames frames = render(GetParam(), {0}).front();
    // Shadow rays to the sky take less light.
    const auto is_dark = [&](std::size_t i) { return light(frames.plain[i]) - light(frames.shadowed[i]) > 200; };
    EXPECT_GT(count_pixels(is_dark), 1000u);
    const std::size_t lone = count_pixels([&](std::size_t i) {
        const std::size_t x = i % size.width, y = i / size.width;
        if (x == 0 || y == 0 || x + 1 == size.width || y + 1 == size.height || !is_dark(i)) return false;
        return !is_dark(i - 1) && !is_dark(i + 1) && !is_dark(i - size.width) && !is_dark(i + size.width);
    });
    EXPECT_LE(lone, 3u);
}

// A pixel with an unchanged surface changes only if the accelerator has moved its occluder.
TEST_P(EmbeddingBy, ShadowsMoveWithThings) {
    const std::vector<Frames> frames = render(GetParam(), {0, 0.05f, 0.1f, 0.05f});
    EXPECT_EQ(differing(frames[1].shadowed, frames[3].shadowed), 0u) << "the same place, the same picture";
    for (std::size_t frame = 1; frame < 3; ++frame) {
        EXPECT_GT(differing(frames[frame - 1].plain, frames[frame].plain), 100u) << "the ring";
        const std::size_t shadows = count_pixels([&](std::size_t i) {
            return frames[frame - 1].plain[i] == frames[frame].plain[i] &&
                   frames[frame - 1].shadowed[i] != frames[frame].shadowed[i];
        });
        EXPECT_GT(shadows, 20u) << "its shadow in frame " << frame;
    }
}

}  // namespace
}  // namespace renderer
