// SPDX-License-Identifier: MIT
// `twinray illumination`: what parallel light, the sky or the sun bring to each face.
#include <twinray/analysis.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/command/values.h"
#include "cli/commands.h"
#include "cli/csv_files.h"
#include "cli/face_groups.h"
#include "cli/ray_grid_options.h"
#include "engine/core/error.h"
#include "samples/support/progress.h"

namespace twinray::cli {
namespace {

enum class Measure : std::uint8_t { area, fraction, irradiance };

struct SkyOptions {
    uint sky = 0;  // rays a face; 0: the sun
    std::vector<double> up = {0, 1, 0};
    std::filesystem::path sun;
    uint samples = 16;
};

struct IlluminationOptions {
    AnalysisOptions analysis;
    RayGridOptions grid;
    SkyOptions sky;
    Sides sides = Sides::both;
    FaceGroupOptions groups;
    Measure measure = Measure::area;
};

const Names<Measure> measures = {
    {"area", Measure::area}, {"fraction", Measure::fraction}, {"irradiance", Measure::irradiance}};
const Names<Sides> sides_by_name = {{"front", Sides::front}, {"both", Sides::both}};

template <class T>
std::string name_in(const Names<T>& names, T wanted) {
    return std::ranges::find(names, wanted, &std::pair<std::string, T>::second)->first;
}

// The divisor of areas; 0 if there is nothing to divide.
double unit_of(const LitArea& lit, Measure measure) {
    switch (measure) {
        case Measure::fraction: return lit.unobstructed;
        case Measure::irradiance: return lit.surface;
        default: return 1;
    }
}

void write(const IlluminationOptions& options, const Illumination& result) {
    const std::string what = name_in(measures, options.measure);
    CsvFile csv(options.analysis.output, text(name_of(options.groups.by), ",hits,", what, ",ci_low,ci_high"));
    const bool has_interval = options.grid.points == GridPoints::random;
    for (std::size_t group = 0; group < result.groups.size(); ++group) {
        const LitArea& lit = result.groups[group];
        const double unit = unit_of(lit, options.measure);
        const auto share = [&](double area) { return unit > 0 ? area / unit : 0; };
        std::optional<double> low, high;
        if (has_interval) low = share(lit.interval.low), high = share(lit.interval.high);
        csv.row({group, lit.hits}, {share(lit.area), low, high});
    }
    csv.close();
}

// The value of its group for each face.
ScenePicture picture_of(const IlluminationOptions& options, const Faces& faces, const Illumination& result) {
    const std::string what = name_in(measures, options.measure);
    std::vector<double> values;
    for (const uint group : faces.groups(options.groups.by)) {
        const LitArea& lit = result.groups[group];
        const double unit = unit_of(lit, options.measure);
        values.push_back(unit > 0 ? lit.area / unit : NAN);
    }
    ScenePicture picture = picture_of_values(options.analysis.pictures, values, what);
    const std::vector<double>& d = options.grid.direction;
    picture.page.title = options.analysis.scene.filename().string() + ": light of one direction";
    picture.page.subtitle = text(what, " by ", name_of(options.groups.by), ", direction ", text_of({d[0], d[1], d[2]}),
                                 ", ", result.ray_count, " rays");
    return picture;
}

void print(const IlluminationOptions& options, const Analysed& analysed, const Illumination& result, double seconds) {
    const LitArea& total = result.total;
    const auto lit =
        std::count_if(result.groups.begin(), result.groups.end(), [](const LitArea& g) { return g.hits > 0; });
    std::cout << analysed.head("illumination", options.analysis) << "  " << speed_text(result.ray_count, seconds)
              << "\n  lit: " << lit << " of " << result.groups.size() << " by " << name_of(options.groups.by)
              << "; area across the light " << total.area;
    if (options.grid.points == GridPoints::random)
        std::cout << " [" << total.interval.low << ", " << total.interval.high << "]";
    std::cout << ", without shadows " << total.unobstructed << '\n';
}

void run(const IlluminationOptions& options) {
    const Analysed analysed(options.analysis);
    Faces faces(*analysed.context, analysed.scene);
    options.groups.set_groups(faces);
    const RayGridDesc grid = options.grid.desc(options.analysis.common);
    Illumination result;
    const double seconds = seconds_of([&] {
        samples::Progress progress("illumination", std::uint64_t{grid.side} * grid.side, options.analysis.common.quiet);
        result = illuminate(
            *analysed.accel, analysed.scene, faces,
            {.grid = grid, .sides = options.sides, .by = options.groups.by, .progress = [&](std::uint64_t rays) {
                 progress.advance(rays);
             }});
    });
    if (!options.analysis.output.empty()) write(options, result);
    if (!options.analysis.pictures.files.empty())
        write_pictures(options.analysis.pictures, *analysed.accel, analysed.scene, picture_of(options, faces, result));
    if (!options.analysis.common.quiet) print(options, analysed, result, seconds);
    nlohmann::json record = {{"sides", name_in(sides_by_name, options.sides)},
                             {"by", name_of(options.groups.by)},
                             {"n", result.ray_count},
                             {"hits", result.total.hits},
                             {"cell_area", result.cell_area},
                             {"area", result.total.area},
                             {"unobstructed", result.total.unobstructed},
                             {"surface", result.total.surface},
                             {"seconds", seconds}};
    record.update(options.grid.record());
    record.update(analysed.record("twinray-illumination/1", options.analysis));
    if (options.grid.points == GridPoints::random)
        record.update({{"ci_low", result.total.interval.low}, {"ci_high", result.total.interval.high}});
    append_json(options.analysis.common.json, record);
}

constexpr uint most_samples = 1u << 20;

void write(const std::filesystem::path& file, const std::string& what, const SkyLight& light) {
    CsvFile csv(file, "face,free_rays," + what + ",ci_low,ci_high");
    for (std::size_t face = 0; face < light.faces.size(); ++face) {
        const Received& received = light.faces[face];
        csv.row({face, received.free_rays}, {received.value, received.interval.low, received.interval.high});
    }
    csv.close();
}

// The mean is by area.
double mean_of(const SkyLight& light, const std::vector<double>& areas) {
    double sum = 0, area = 0;
    for (std::size_t face = 0; face < areas.size(); ++face) {
        sum += areas[face] * light.faces[face].value;
        area += areas[face];
    }
    return area > 0 ? sum / area : 0;
}

ScenePicture picture_of(const AnalysisOptions& analysis, const SkyOptions& options, const SkyLight& light,
                        const std::vector<double>& areas) {
    std::vector<double> values;
    for (std::size_t face = 0; face < areas.size(); ++face)
        values.push_back(areas[face] > 0 ? light.faces[face].value : NAN);
    const bool is_sky = options.sky > 0;
    ScenePicture picture = picture_of_values(analysis.pictures, values, is_sky ? "sky" : "hours");
    picture.page.title = analysis.scene.filename().string() + (is_sky ? ": light of the sky" : ": hours of sun");
    picture.page.subtitle = text("mean over the surface ", mean_of(light, areas), ", ", light.ray_count, " rays");
    return picture;
}

// --sky and --sun, and those that need them.
std::vector<Option> sky_options(SkyOptions& options) {
    return {
        {.name = "--sky",
         .value = number(options.sky, {1, most_samples}),
         .help = "compute the light of a uniform sky above the horizon, with N rays per face"},
        {.name = "--sun",
         .value = cli::file(options.sun),
         .help = "compute hours of sun from a CSV file of x,y,z,hours: the direction in which sunlight travels, and "
                 "for how long"},
        {.name = "--up", .value = numbers(options.up, "X Y Z"), .help = "direction of the zenith", .needs = {"--sky"}},
        {.name = "--samples",
         .value = number(options.samples, {1, most_samples}),
         .help = "points per face for each position of the sun",
         .needs = {"--sun"}}};
}

void run_sky(const AnalysisOptions& analysis, const SkyOptions& options, Sides sides) {
    const std::vector<SunPosition> sun = options.sky ? std::vector<SunPosition>() : read_sun(options.sun);
    const Analysed analysed(analysis);
    const Faces faces(*analysed.context, analysed.scene);
    const uint samples = options.sky ? options.sky : options.samples;
    const std::string what = options.sky ? "sky" : "hours";
    SkyLight light;
    const double seconds = seconds_of([&] {
        samples::Progress progress(what, faces.count() * samples * std::max<std::size_t>(sun.size(), 1),
                                   analysis.common.quiet);
        const SkyRaysDesc desc{
            .samples = samples, .sides = sides, .seed = analysis.common.seed, .progress = [&](std::uint64_t rays) {
                progress.advance(rays);
            }};
        light = options.sky ? sky_light(*analysed.accel, analysed.scene, faces,
                                        {options.up[0], options.up[1], options.up[2]}, desc)
                            : sun_hours(*analysed.accel, analysed.scene, faces, sun, desc);
    });
    if (!analysis.output.empty()) write(analysis.output, what, light);
    if (!analysis.pictures.files.empty())
        write_pictures(analysis.pictures, *analysed.accel, analysed.scene,
                       picture_of(analysis, options, light, faces.areas()));
    const double mean = mean_of(light, faces.areas());
    if (!analysis.common.quiet)
        std::cout << analysed.head("illumination", analysis) << "  " << speed_text(light.ray_count, seconds) << "\n  "
                  << (options.sky ? "light of the sky" : "hours of sun") << ", mean over the surface: " << mean << '\n';
    nlohmann::json record = {{"what", what},         {"sides", sides == Sides::front ? "front" : "both"},
                             {"samples", samples},   {"positions", sun.size()},
                             {"n", light.ray_count}, {"mean", mean},
                             {"seconds", seconds}};
    record.update(analysed.record("twinray-sky/1", analysis));
    append_json(analysis.common.json, record);
}

}  // namespace

Command illumination_command() {
    const auto options = std::make_shared<IlluminationOptions>();
    Section light = {"Light", ray_grid_options(options->grid)};
    for (Option& option : sky_options(options->sky)) light.options.push_back(std::move(option));
    light.options.push_back({.name = "--sides",
                             .value = choice(options->sides, sides_by_name),
                             .help = "sides of faces that receive light"});
    Section output = analysis_output(options->analysis,
                                     "write a CSV file with one line per face: face, hits, area, ci_low, ci_high; with "
                                     "--sky or --sun: face, free_rays, sky or hours, ci_low, ci_high");
    for (Option& option : face_group_options(options->groups, "one line of the CSV", {"--direction"}))
        output.options.push_back(std::move(option));
    output.options.push_back(
        {.name = "--measure",
         .value = choice(options->measure, measures),
         .help = "third column of the CSV: lit area perpendicular to the light, fraction of the area that faces the "
                 "light, or irradiance, which is lit area perpendicular to the light per unit of surface",
         .needs = {"--direction"}});
    Section pictures = picture_options(options->analysis.pictures, "the third column of the CSV");
    pictures.options.push_back(color_scale_option(options->analysis.pictures));
    return {.name = "illumination",
            .group = "Analyses",
            .summary = "compute the parallel light, sky light or hours of sun of each face",
            .description =
                "Computes how much of each face parallel light reaches, how much of a uniform sky it sees, or for how "
                "many hours the sun shines on it, with 95 % confidence intervals.",
            .positionals = {scene_argument(options->analysis.scene)},
            .sections = {light, output, pictures, common_options(options->analysis.common)},
            .alternatives = {{.names = {"--direction", "--sky", "--sun"}, .is_required = true}},
            .examples = {{"twinray illumination house.glb --direction 0.3 -1 0.2 -o lit.csv --picture lit.png",
                          "the faces that the sun reaches, as a table and as a picture"}},
            .run = [options] {
                options->grid.direction.empty() ? run_sky(options->analysis, options->sky, options->sides)
                                                : run(*options);
                return 0;
            }};
}

}  // namespace twinray::cli
