// SPDX-License-Identifier: MIT
// The path tracer, compared with Mitsuba 3 on the same triangles and materials (bench/peers/renderers.py).
#include <fstream>

#include <nlohmann/json.hpp>

#include "renderer/reference.h"
#include "tests/samples/render.h"

namespace twinray::path_tracer {
namespace {

class PeersTest : public test::VulkanTest {};

// The means over blocks of pixels, by channel, and their standard errors.
struct Blocks {
    std::vector<double> mean, error;
};

struct Reference {
    Blocks blocks;
    uint side, block, depth;
    std::unique_ptr<EnvironmentMap> sky;
};

Reference load_reference(const std::string& name) {
    std::ifstream in(std::string(TWINRAY_PEERS_FOLDER "/") + name + ".json");
    const nlohmann::json json = nlohmann::json::parse(in);
    Reference reference{{json["mean"], json["error"]}, json["side"], json["block"], json["depth"], nullptr};
    if (!json.contains("sky")) return reference;
    HdrImage image;
    const std::vector<float> sky = json["sky"];
    image.width = json["sky_width"];
    image.height = static_cast<uint>(sky.size() / 3 / image.width);
    for (std::size_t i = 0; i < sky.size(); i += 3) image.rgb.push_back({sky[i], sky[i + 1], sky[i + 2]});
    reference.sky = std::make_unique<EnvironmentMap>(std::move(image));
    return reference;
}

// Renders with different seeds.
Blocks rendered_blocks(Context& context, const Scene& scene, Reference& reference, uint runs) {
    std::vector<double> sums(reference.blocks.mean.size()), squares(sums.size());
    RenderSetup setup;
    setup.settings = {.width = reference.side,
                      .height = reference.side,
                      .samples = 16,
                      .max_depth = reference.depth,
                      .camera = camera_rays(scene.cameras[0], 1),
                      .filter = FILTER_BOX};
    setup.environment = std::move(reference.sky);
    for (setup.settings.seed = 1; setup.settings.seed <= runs; ++setup.settings.seed) {
        const std::vector<double> means = block_means(render(context, scene, setup), reference.block);
        for (std::size_t i = 0; i < sums.size(); ++i) {
            sums[i] += means[i];
            squares[i] += means[i] * means[i];
        }
    }
    Blocks blocks;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double mean = sums[i] / runs;
        blocks.mean.push_back(mean);
        blocks.error.push_back(std::sqrt(std::max(squares[i] / runs - mean * mean, 0.0) / (runs - 1)));
    }
    return blocks;
}

void expect_alike(Context& context, const std::string& name) {
    const Scene scene = load_scene(std::string(TWINRAY_PEERS_FOLDER "/") + name + ".gltf");
    Reference reference = load_reference(name);
    const Blocks blocks = rendered_blocks(context, scene, reference, 16);
    double sum = 0, squares = 0, largest = 0;
    for (std::size_t i = 0; i < blocks.mean.size(); ++i) {
        const double z =
            (blocks.mean[i] - reference.blocks.mean[i]) / std::hypot(blocks.error[i], reference.blocks.error[i]);
        sum += z;
        squares += z * z;
        largest = std::max(largest, std::abs(z));
    }
    const auto count = static_cast<double>(blocks.mean.size());
    // The channels of a block go together, so there are a third as many independent scores; those of 16 runs have a
    // variance of 15 / 13.
    EXPECT_LT(std::abs(sum / count), 4 / std::sqrt(count / 3));
    EXPECT_LT(squares / count, 15.0 / 13 + 4 * std::sqrt(2 / (count / 3)));
    EXPECT_GT(squares / count, 1 - 4 * std::sqrt(2 / (count / 3)));
    EXPECT_LT(largest, 6);
    testing::Test::RecordProperty("rms_z", std::to_string(std::sqrt(squares / count)));
}

TEST_F(PeersTest, MitsubasCornellBoxLooksAsByMitsuba) { expect_alike(context(), "cornell_box"); }
TEST_F(PeersTest, MetalAndGlassLookAsByMitsuba) { expect_alike(context(), "metal_and_glass"); }
TEST_F(PeersTest, TexturesUnderASkyLookAsByMitsuba) { expect_alike(context(), "textured_sky"); }

}  // namespace
}  // namespace twinray::path_tracer
