// Pictures compared with others: of the other accelerator, of another renderer, of more samples.
#include "report/suite/sections.h"

#include <fstream>

#include <nlohmann/json.hpp>
#include "cornell_box.gltf.h"
#include "cornell_box.json.h"
#include "renderer/camera.h"
#include "renderer/cross_check.h"
#include "renderer/reference.h"
#include "report/suite/estimators.h"
#include "report/suite/pictures.h"
#include "engine/core/files.h"

namespace twinray::suite {
namespace {

// Counts the disagreeing rays that SwTlas is wrong about.
std::uint64_t faults_of_ours_in(const Scene& scene, std::span<const path_tracer::Disagreement> rays) {
    if (rays.empty()) return 0;
    const ReferenceScene reference = ReferenceScene::of(scene);
    std::uint64_t faults = 0;
    for (const path_tracer::Disagreement& d : rays) {
        const RayResult ray_result = d.is_any ? classify_any(reference, d.ray, d.second.hit != 0, d.first.hit != 0)
                                              : classify(reference, d.ray, d.second, d.first);
        faults += is_fault_of_ours(*ray_result.software);
    }
    return faults;
}

void by_both_accelerators(CaseRun& run) {
    const std::vector<Configuration> configurations = analysis_configurations(run);
    if (configurations.size() < 2 || configurations[1].backend != Backend::ray_query)
        return run.add_not_run("needs SwTlas and ray queries, to trace each ray on both");
    RenderDesc desc = cornell_box_shot(48);
    desc.settings.samples = static_cast<uint>(run.amount(4, 64));
    desc.settings.seed = static_cast<uint>(run.seed());
    RenderFixture software(run, configurations[0], desc), hardware(run, configurations[1], desc);
    const std::uint64_t pixels = std::uint64_t{desc.settings.width} * desc.settings.height;
    path_tracer::CrossChecker checker(hardware.context(), software.accel(), hardware.renderer(), pixels);
    const HdrImage by_hardware = render_picture(hardware.renderer(), desc.settings, hardware.accel(), true, &checker);
    const Exposure by_software = software.expose(run.seed(), desc.settings.samples);
    const path_tracer::PictureDifference difference =
        path_tracer::compare_pictures(by_hardware, by_software.picture, checker.marks());
    Record record = run.record(configurations[0]);
    record.reference = "invariance";
    record.params = {{"spp", desc.settings.samples}};
    record.n = pixels;
    record.counts = {{"DIFFERING", difference.differing}, {"RAYS_DISAGREEING", checker.found()}};
    const std::uint64_t ours = faults_of_ours_in(desc.scene, checker.recorded());
    software.census().add_to(record);
    add_checked(run, record, difference.unexplained + ours,
                text(difference.unexplained,
                     " pixels differ without a ray that does; of the rays, SwTlas is wrong about ", ours));
}

// A way of sampling pictures: a curve of the plots.
struct Method {
    uint strategy;
    uint block_size;
    std::string name() const {
        return name_of_strategy(strategy) + (block_size == 1 ? ", sobol" : text(", blocks of ", block_size));
    }
};

// The results of one method for the box on one configuration: pictures by seed, then by samples.
struct ExposureSeries {
    Configuration configuration;
    Method method;
    Census census;
    std::vector<std::vector<Exposure>> exposures;
};

std::uint64_t seed_of(const CaseRun& run, std::size_t method, std::size_t seed) {
    return run.seed() + 1000 * (method + 1) + seed;
}

struct Reference {
    HdrImage image;
    double noise = 0;  // what its own variance adds to the relMSE of a picture
};

// Returns the mean of the pictures with the most samples by both light and surface sampling, of all other seeds and
// methods of the first configuration: none shares a random number with the compared picture.
Reference reference_without(std::span<const ExposureSeries> of_configuration, std::size_t method, std::size_t seed) {
    std::vector<const HdrImage*> pictures;
    for (std::size_t m = 0; m < of_configuration.size(); ++m)
        for (std::size_t s = 0; s < of_configuration[m].exposures.size(); ++s)
            if (of_configuration[m].method.strategy == path_tracer::STRATEGY_MIS && (m != method || s != seed))
                pictures.push_back(&of_configuration[m].exposures[s].back().picture);
    const auto count = static_cast<double>(pictures.size());
    Reference reference{{pictures[0]->width, pictures[0]->height, {}}};
    const auto values = static_cast<double>(3 * pictures[0]->rgb.size());
    for (std::size_t i = 0; i < pictures[0]->rgb.size(); ++i) {
        dvec3 mean(0), squares(0);
        for (const HdrImage* picture : pictures) mean += dvec3(picture->rgb[i]) / count;
        for (const HdrImage* picture : pictures)
            squares += (dvec3(picture->rgb[i]) - mean) * (dvec3(picture->rgb[i]) - mean);
        reference.image.rgb.emplace_back(mean);
        for (int channel = 0; channel < 3; ++channel)
            reference.noise +=
                squares[channel] / (count * (count - 1)) / (mean[channel] * mean[channel] + 0.01) / values;
    }
    return reference;
}

// Returns for each seed the mean over pixels of the squared deviation of luminance, times n / (n - 1) for n seeds. The
// mean of these is the variance between seeds.
std::vector<double> squared_deviations(std::span<const std::vector<Exposure>> seeds, std::size_t at) {
    const std::size_t pixels = seeds[0][at].picture.rgb.size();
    std::vector<double> mean(pixels), result;
    const auto n = static_cast<double>(seeds.size());
    for (const auto& exposures : seeds)
        for (std::size_t i = 0; i < pixels; ++i)
            mean[i] += static_cast<double>(path_tracer::luminance(exposures[at].picture.rgb[i])) / n;
    for (const auto& exposures : seeds) {
        double sum = 0;
        for (std::size_t i = 0; i < pixels; ++i)
            sum += std::pow(static_cast<double>(path_tracer::luminance(exposures[at].picture.rgb[i])) - mean[i], 2);
        result.push_back(sum / static_cast<double>(pixels) * n / (n - 1));
    }
    return result;
}

void add_figures(CaseRun& run, std::span<const ExposureSeries> all, std::size_t of_configuration, std::size_t which,
                 std::span<const uint> spp) {
    const ExposureSeries& series = all[which];
    std::vector<Reference> references;
    for (std::size_t seed = 0; seed < series.exposures.size(); ++seed)
        references.push_back(reference_without(all.first(of_configuration), which % of_configuration, seed));
    for (std::size_t at = 0; at < spp.size(); ++at) {
        std::vector<double> errors, flips, ms;
        for (std::size_t seed = 0; seed < references.size(); ++seed) {
            const Exposure& exposure = series.exposures[seed][at];
            const auto& [image, noise] = references[seed];
            errors.push_back(path_tracer::error_against(exposure.picture, image).relative_mse - noise);
            flips.push_back(mean_flip(exposure.picture, {image.width, image.height, image.rgb}));
            ms.push_back(exposure.ms);
        }
        const std::vector<double> variances = squared_deviations(series.exposures, at);
        const auto add = [&](const char* metric, const std::vector<double>& of_seeds, bool is_first) {
            Record record = run.record(series.configuration);
            record.params = {{"measure", metric}, {"spp", spp[at]}};
            record.variant = series.method.name();
            record.criterion = "none: measured";
            record.reference = "other seeds";
            record.n = of_seeds.size();
            record.error = error_figures(metric, of_seeds, 0);
            record.time = time_figures("ms_per_picture", ms);
            if (is_first) set_efficiency(record, variances, ms);
            if (is_first && at == 0) series.census.add_to(record);
            run.add(record);
        };
        add("relMSE", errors, true);
        add("variance", variances, false);
        add("FLIP", flips, false);
    }
}

void work_and_precision(CaseRun& run) {
    const std::vector<uint> spp =
        run.amount(0, 1) ? std::vector<uint>{1, 2, 4, 8, 16, 32, 64} : std::vector<uint>{1, 2, 4};
    const std::size_t seeds = run.amount(3, 16);
    const std::vector<Method> methods = {{path_tracer::STRATEGY_MIS, 1},
                                         {path_tracer::STRATEGY_MIS, 2},
                                         {path_tracer::STRATEGY_LIGHTS, 1},
                                         {path_tracer::STRATEGY_BSDF, 1}};
    std::vector<ExposureSeries> all;
    for (const Configuration& configuration : analysis_configurations(run))
        for (std::size_t method = 0; method < methods.size(); ++method) {
            RenderDesc desc = cornell_box_shot(32);
            desc.settings.strategy = methods[method].strategy;
            desc.settings.block_size = methods[method].block_size;
            RenderFixture fixture(run, configuration, desc);
            ExposureSeries series{configuration, methods[method], {}, {}};
            for (std::size_t seed = 0; seed < seeds; ++seed)
                series.exposures.push_back(fixture.expose(seed_of(run, method, seed), spp));
            series.census = fixture.census();
            all.push_back(std::move(series));
        }
    for (std::size_t which = 0; which < all.size(); ++which) add_figures(run, all, methods.size(), which, spp);
}

// ---- The path tracer's pictures, compared with those of another renderer.

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

}  // namespace

std::vector<SuiteCase> picture_error_cases() {
    return {
        {"P13", "the Cornell box by both accelerators, with the same random numbers",
         "pixels that differ, and rays on which the two disagree",
         "no pixel differs without such a ray, and SwTlas is wrong about none", by_both_accelerators},
        {"P16", "the Cornell box of Mitsuba 3, against pictures by it", "z-scores of blocks of 8 x 8 pixels, relMSE",
         "a mean and a root mean square of the z-scores that noise explains", by_mitsuba},
        {"P19", "the built-in Cornell box, samples from 1 to 4 (64 in full)",
         "relMSE (epsilon 0.01), variance, FLIP, efficiency", "none: measured", work_and_precision},
    };
}

}  // namespace twinray::suite
