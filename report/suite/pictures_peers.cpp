// SPDX-License-Identifier: MIT
// The path tracer's pictures, compared with those of another renderer.
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include <twinray/scene.h>

#include "cornell_box.gltf.h"
#include "cornell_box.json.h"
#include "validation/records/temporary_folder.h"
#include "report/suite/estimators.h"
#include "report/suite/pictures.h"
#include "report/suite/queries.h"
#include "report/suite/sections.h"
#include "renderer/camera.h"
#include "renderer/reference.h"

namespace twinray::suite {
namespace {

struct Scores {
    double mean = 0, rms = 0, largest = 0, relative_mse = 0;
};

// Compares runs of different seeds with means that have standard errors.
Scores scores_of(std::span<const std::vector<double>> runs, std::span<const double> mean,
                 std::span<const double> error) {
    Scores scores;
    const auto n = static_cast<double>(runs.size()), count = static_cast<double>(mean.size());
    for (std::size_t i = 0; i < mean.size(); ++i) {
        double sum = 0, squares = 0;
        for (const std::vector<double>& run : runs) sum += run[i] / n;
        for (const std::vector<double>& run : runs) squares += std::pow(run[i] - sum, 2);
        const double z = (sum - mean[i]) / std::hypot(std::sqrt(squares / (n - 1) / n), error[i]);
        scores.mean += z / count;
        scores.rms += z * z / count;
        scores.largest = std::max(scores.largest, std::abs(z));
        scores.relative_mse += std::pow(sum - mean[i], 2) / (mean[i] * mean[i] + 0.01) / count;
    }
    scores.rms = std::sqrt(scores.rms);
    return scores;
}

// Loads the scene of a file with this text, which contains all its data.
Scene scene_of_gltf(std::string_view gltf) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "scene.gltf";
    std::ofstream(file) << gltf;
    return load_scene(file);
}

}  // namespace

// Compares with pictures of tests/samples/peers, with 12,288 samples per pixel, which are part of this program.
void by_mitsuba(CaseRun& run) {
    const nlohmann::json json = nlohmann::json::parse(cornell_box_json);
    const std::vector<double> mean = json["mean"], error = json["error"];
    RenderDesc desc{.scene = scene_of_gltf(cornell_box_gltf)};
    desc.settings.width = desc.settings.height = json["side"];
    desc.settings.max_depth = json["depth"];
    desc.settings.filter = path_tracer::FILTER_BOX;
    desc.settings.camera = path_tracer::camera_rays(desc.scene.cameras[0], 1);
    for (const Configuration& configuration : analysis_configurations(run)) {
        RenderFixture fixture(run, configuration, desc);
        std::vector<std::vector<double>> runs;
        std::vector<double> ms;
        const std::size_t seeds = run.amount(10, 32);
        for (std::size_t seed = 0; seed < seeds; ++seed) {
            const Exposure exposure = fixture.expose(run.seed() + seed, static_cast<uint>(run.amount(2, 64)));
            runs.push_back(path_tracer::block_means(exposure.picture, json["block"]));
            ms.push_back(exposure.ms);
        }
        const Scores scores = scores_of(runs, mean, error);
        // The channels of a block are correlated: a third as many scores are independent, with Student's variance.
        const double independent = static_cast<double>(mean.size()) / 3, n = static_cast<double>(seeds);
        const double expected = std::sqrt((n - 1) / (n - 3)), allowed = 4 / std::sqrt(independent);
        Record record = run.record(configuration);
        record.reference = "Mitsuba 3";
        record.n = mean.size();
        record.time = time_figures("ms_per_picture", ms);
        record.results = {{"seeds", seeds},
                          {"z_mean", scores.mean},
                          {"z_rms", scores.rms},
                          {"z_largest", scores.largest},
                          {"relMSE", scores.relative_mse}};
        record.faults = !(std::abs(scores.mean) < allowed) || !(scores.rms < expected + 1.5 * allowed);
        fixture.census().add_to(record);
        add_judged(run, record, "more than the noise of both explains");
    }
}

}  // namespace twinray::suite
