#include "report/suite/pictures.h"

#include <cmath>

#include <twinray/scene.h>

#include "engine/core/statistics.h"
#include "renderer/camera.h"
#include "engine/core/error.h"

namespace twinray::suite {
namespace {

constexpr double rounding_of_path = 2e-6;  // of what float32 adds up along a path, relative

// The picture of one seed.
struct FlatPicture {
    double mean = 0, variance = 0;  // of the pixels
    double rms = 0;                 // of their relative errors
};

FlatPicture checked(const HdrImage& picture, double truth) {
    const auto n = static_cast<double>(picture.rgb.size());
    FlatPicture result;
    result.mean = mean_of(picture);
    double squares = 0;
    for (const vec3& pixel : picture.rgb) {
        result.variance += std::pow(static_cast<double>(pixel.y) - result.mean, 2) / (n - 1);
        squares += std::pow(static_cast<double>(pixel.y) - truth, 2) / n;
    }
    result.rms = std::sqrt(squares) / truth;
    return result;
}

// Some hundred pictures of any seed must all pass: the spread of few pixels is itself a guess.
constexpr double most_standard_errors = 6;

void check(Record& record, const FlatQuestion& question, std::span<const FlatPicture> pictures) {
    const auto n = static_cast<double>(pictures.size());
    const double pixels = double{1} * question.desc.settings.width * question.desc.settings.height;
    double mean = 0, variance = 0;
    for (const FlatPicture& picture : pictures) mean += picture.mean / n, variance += picture.variance / n;
    const double deviation = std::sqrt(variance / (n * pixels)), off = mean - question.value;
    record.results = {{"mean", mean}, {"expected", question.value}};
    if (deviation > 0) record.results.emplace("z", off / deviation);
    record.faults = !(std::abs(off) <= most_standard_errors * deviation + rounding_of_path * question.value);
    record.pass = record.faults == 0;
    if (*record.pass) return;
    record.reason = text("the mean of all pixels is ", mean, " +- ", deviation, ", not ", question.value);
}

}  // namespace

path_tracer::CameraRays look(vec3 from, vec3 at, float half_height) {
    const vec3 way = normalize(at - from);
    Camera camera = look_camera(from, at, std::abs(way.y) > 0.9f ? vec3(0, 0, 1) : vec3(0, 1, 0), 45);
    camera.vertical_fov = 2 * std::atan(half_height);
    return path_tracer::camera_rays(camera, 1);
}

RenderDesc cornell_box_shot(uint side) {
    RenderDesc desc{.scene = cornell_box_scene()};
    desc.settings.width = desc.settings.height = side;
    desc.settings.camera = path_tracer::camera_rays(desc.scene.cameras[0], 1);
    return desc;
}

double mean_of(const HdrImage& picture) {
    const auto n = static_cast<double>(picture.rgb.size());
    double mean = 0;
    for (const vec3& pixel : picture.rgb) mean += static_cast<double>(pixel.y) / n;
    return mean;
}

void add(Scene& scene, Mesh mesh, const Material& material) {
    mesh.materials.assign(mesh.triangles.size(), static_cast<uint>(scene.materials.size()));
    scene.materials.push_back(material);
    scene.instances.push_back({mesh.name, static_cast<uint>(scene.meshes.size()), {}});
    scene.meshes.push_back(std::move(mesh));
}

Material lambert(float albedo) {
    return {.name = "lambert", .base_color = vec4(vec3(albedo), 1), .metallic = 0, .roughness = 1, .ior = 1};
}

Material lamp(float radiance) {
    return {.name = "lamp", .base_color = vec4(0, 0, 0, 1), .metallic = 0, .emission = vec3(radiance), .ior = 1};
}

std::string name_of_strategy(uint strategy) {
    return strategy == path_tracer::STRATEGY_MIS      ? "MIS"
           : strategy == path_tracer::STRATEGY_LIGHTS ? "lights"
                                                      : "surfaces";
}

void Census::add(const HdrImage& picture) {
    pixels += picture.rgb.size();
    for (const vec3& pixel : picture.rgb) {
        not_finite += !is_finite(pixel);
        negative += pixel.x < 0 || pixel.y < 0 || pixel.z < 0;
    }
}

void Census::add_to(Record& record) const {
    record.counts.insert(
        {{"PIXELS", pixels}, {"NOT_FINITE", not_finite}, {"NEGATIVE", negative}, {"DROPPED", dropped}});
}

RenderFixture::RenderFixture(CaseRun& run, const Configuration& configuration, const RenderDesc& desc)
    : settings_(desc.settings),
      context_(run.devices().context(configuration.backend)),
      accel_(run.devices().empty_accel(configuration)),
      sky_(path_tracer::constant_sky(vec3(desc.sky))),
      scene_(context_, desc.scene, path_tracer::collect_lights(desc.scene), desc.sky > 0 ? &sky_ : nullptr),
      renderer_(context_, scene_, desc.settings) {
    push_scene(accel_, desc.scene);
    accel_.sync();
    const auto depth = std::min(settings_.max_depth, 2u);
    RenderSettings settings = settings_;
    settings.max_depth = depth;
    path_tracer::Renderer once(context_, scene_, settings);
    settings.samples = settings.block_size;
    render_picture(once, settings, accel_, true);
}

std::vector<Exposure> RenderFixture::expose(std::uint64_t seed, std::span<const uint> spp) {
    renderer_.set_frame(settings_.camera, static_cast<uint>(seed));
    path_tracer::Film film = renderer_.make_film();
    renderer_.start(film);
    std::vector<Exposure> exposures;
    uint block = 0;
    for (const uint samples : spp) {
        for (; block < samples / settings_.block_size; ++block) renderer_.add_block(accel_, block);
        renderer_.read(film);
        exposures.push_back({film.mean(), renderer_.stats().seconds * 1e3});
        census_.add(exposures.back().picture);
    }
    census_.dropped += renderer_.stats().non_finite;
    return exposures;
}

Exposure RenderFixture::expose(std::uint64_t seed, uint spp) { return std::move(expose(seed, {&spp, 1}).front()); }

void measure_flat(CaseRun& run, const Configuration& configuration, const FlatQuestion& question) {
    RenderFixture fixture(run, configuration, question.desc);
    std::vector<std::vector<FlatPicture>> pictures(question.spp.size());
    std::vector<std::vector<double>> ms(question.spp.size());
    for (std::size_t seed = 0; seed < question.seeds; ++seed) {
        const std::vector<Exposure> exposures = fixture.expose(run.seed() + seed, question.spp);
        for (std::size_t i = 0; i < exposures.size(); ++i) {
            pictures[i].push_back(checked(exposures[i].picture, question.value));
            ms[i].push_back(exposures[i].ms);
        }
    }
    for (std::size_t i = 0; i < question.spp.size(); ++i) {
        Record record = run.record(configuration);
        record.params = question.params;
        if (question.is_swept) record.params.emplace("spp", question.spp[i]);
        record.variant = question.variant;
        record.reference = "analytic";
        record.n = question.seeds;
        std::vector<double> errors, variances;
        for (const FlatPicture& picture : pictures[i]) {
            errors.push_back(picture.rms);
            variances.push_back(picture.variance / (question.value * question.value));
        }
        record.error = error_figures("relative", errors);
        if (variances.front() > 0) record.error->floor = 0;  // noise bounds it
        record.time = time_figures("ms_per_picture", ms[i]);
        check(record, question, pictures[i]);
        set_efficiency(record, variances, ms[i]);
        if (i == 0) fixture.census().add_to(record);
        run.add_computed(record);
    }
}

void set_efficiency(Record& record, std::span<const double> variances, std::span<const double> ms) {
    const auto efficiency = [&](std::span<const std::size_t> items) {
        double variance = 0, seconds = 0;
        for (const std::size_t item : items) variance += variances[item], seconds += ms[item] / 1e3;
        const auto n = static_cast<double>(items.size());
        return n * n / (variance * seconds);
    };
    std::vector<std::size_t> all(variances.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    const double value = efficiency(all);
    if (!std::isfinite(value)) return;
    const Interval interval = bootstrap_interval_95(all.size(), efficiency);
    record.results.emplace("efficiency", value);
    record.results.emplace("efficiency_low", interval.low);
    record.results.emplace("efficiency_high", interval.high);
}

}  // namespace twinray::suite
