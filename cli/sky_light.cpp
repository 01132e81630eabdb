// SPDX-License-Identifier: MIT
#include "cli/sky_light.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/command/values.h"
#include "cli/csv_files.h"
#include "engine/core/error.h"
#include "validation/records/progress.h"

namespace twinray::cli {
namespace {

constexpr uint most_samples = 1u << 20;

void write(const std::filesystem::path& file, const std::string& what, const SkyLight& light) {
    CsvFile csv(file, "face,free_rays," + what + ",ci_low,ci_high");
    for (std::size_t face = 0; face < light.faces.size(); ++face) {
        const Received& received = light.faces[face];
        csv.row({face, received.free_rays}, {received.value, received.interval.low, received.interval.high});
    }
    csv.close();
}

// By area.
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

}  // namespace

std::vector<Option> sky_options(SkyOptions& options) {
    return {{.name = "--sky",
             .value = number(options.sky, {1, most_samples}),
             .help = "what a uniform sky above the horizon brings, by N rays a face"},
            {.name = "--sun",
             .value = cli::file(options.sun),
             .help = "hours of sun, from a CSV of x,y,z,hours: in which directions its rays go, and for how long"},
            {.name = "--up", .value = numbers(options.up, "X Y Z"), .help = "where the zenith is", .needs = {"--sky"}},
            {.name = "--samples",
             .value = number(options.samples, {1, most_samples}),
             .help = "points of each face for each position of the sun",
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
        Progress progress(what, faces.count() * samples * std::max<std::size_t>(sun.size(), 1), analysis.common.quiet);
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

}  // namespace twinray::cli
