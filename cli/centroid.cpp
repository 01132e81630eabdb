// SPDX-License-Identifier: MIT
// `twinray centroid`: the mean of what is seen along a direction.
#include <iostream>

#include "cli/ray_grid_options.h"
#include "engine/analysis/centroid.h"

namespace twinray::cli {
namespace {

struct CentroidOptions {
    AnalysisOptions analysis;
    RayGridOptions grid;
};

void write(const std::filesystem::path& file, const Centroid& result) {
    CsvFile csv(file, "x,y,z");
    for (const dvec3& point : result.points) csv.row({}, {point.x, point.y, point.z});
    csv.close();
}

void print(const CentroidOptions& options, const Analysed& analysed, const Centroid& result, double seconds) {
    std::cout << "centroid " << options.analysis.scene.filename().string() << ": " << count_triangles(analysed.scene)
              << " faces, " << analysed.accel->name() << " on " << analysed.context->facts().name << "\n  "
              << speed_text(result.ray_count, seconds) << "\n  ";
    if (result.mean) {
        std::cout << "mean of " << result.point_count << " points: " << text_of(*result.mean);
        if (result.standard_error) std::cout << ", standard error " << text_of(*result.standard_error);
        std::cout << '\n';
    } else {
        std::cout << "no ray hits anything: there is no mean\n";
    }
}

nlohmann::json list_of(const std::optional<dvec3>& v) {
    return v ? nlohmann::json{v->x, v->y, v->z} : nlohmann::json(nullptr);
}

void run(const CentroidOptions& options) {
    const Analysed analysed(options.analysis);
    const RayGridDesc grid = options.grid.desc(options.analysis.common);
    Centroid result;
    const double seconds = seconds_of([&] {
        Progress progress("centroid", std::uint64_t{grid.side} * grid.side, options.analysis.common.quiet);
        result = centroid(*analysed.accel, analysed.scene,
                          {.grid = grid, .keeps_points = !options.analysis.output.empty(), .progress = &progress});
    });
    if (!options.analysis.output.empty()) write(options.analysis.output, result);
    if (!options.analysis.common.quiet) print(options, analysed, result, seconds);
    nlohmann::json record = {{"schema", "twinray-centroid/1"},
                             {"n", result.ray_count},
                             {"points_hit", result.point_count},
                             {"mean", list_of(result.mean)},
                             {"standard_error", list_of(result.standard_error)},
                             {"seconds", seconds}};
    record.update(options.grid.record());
    record.update(analysed.record(options.analysis));
    append_json(options.analysis.common.json, record);
}

}  // namespace

void add_centroid(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand("centroid", "the mean of what is seen along a direction");
    const auto options = std::make_shared<CentroidOptions>();
    add_analysis_options(*command, options->analysis, "CSV of the points: x,y,z");
    add_ray_grid_options(*command, *command, options->grid)->required();
    command->callback([options] { run(*options); });
}

}  // namespace twinray::cli
