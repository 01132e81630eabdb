// `twinray centroid`: the mean of what is seen along a direction.
#include "cli/analysis_options.h"

namespace twinray::cli {
namespace {

struct CentroidOptions : AnalysisOptions {
    RayGridOptions grid;
};

// Writes the points in the coordinates of the scene's file.
void write(const std::filesystem::path& file, const Centroid& result, const dvec3& origin) {
    write_rows(file, "x,y,z", result.points.size(), [&](std::size_t i) -> CsvRow {
        const dvec3 point_in_file = origin + result.points[i];
        return {{}, {point_in_file.x, point_in_file.y, point_in_file.z}};
    });
}

void print(const CentroidOptions& options, const Analysed& analysed, const Centroid& result, double seconds) {
    std::cout << analysed.head("centroid", options) << "  " << speed_text(result.ray_count, seconds) << "\n  ";
    if (result.mean) {
        std::cout << "mean of " << result.point_count
                  << " points: " << coordinate_text(*result.mean, analysed.scene.origin);
        if (result.standard_error) std::cout << ", standard error " << text_of(*result.standard_error);
        std::cout << '\n';
    } else {
        std::cout << "no ray hits anything, so there is no mean\n";
    }
}

// Shows some of the points, evenly chosen, and their mean, which most often lies inside the object.
ScenePicture picture_of(const CentroidOptions& options, const Analysed& analysed, const Centroid& result) {
    constexpr std::size_t most_points = 4000;
    constexpr float radius = 7;
    ScenePicture picture;
    picture.page.title = options.scene.filename().string() + ": centroid";
    picture.page.subtitle = "no ray hits anything";
    if (result.mean)
        picture.page.subtitle =
            text("mean of ", result.point_count, " points: ", coordinate_text(*result.mean, analysed.scene.origin));
    picture.page.legend.entries = {{categorical::vermilion, "mean"}, {categorical::blue, "points"}};
    picture.colors.assign(count_triangles(analysed.scene), plain_color);
    const std::size_t count = std::min(result.points.size(), most_points);
    for (std::size_t i = 0; i < count; ++i)
        picture.dots.push_back(
            {.position = result.points[i * result.points.size() / count], .radius = 1.2f, .color = categorical::blue});
    if (result.mean) {
        picture.dots.push_back({.position = *result.mean, .radius = radius + 2, .color = paper, .behind = 1});
        picture.dots.push_back(
            {.position = *result.mean, .radius = radius, .color = categorical::vermilion, .behind = 1});
    }
    return picture;
}

nlohmann::json list_or_null(const std::optional<dvec3>& v) { return v ? list_of(*v) : nlohmann::json(nullptr); }

void run(const CentroidOptions& options) {
    const Analysed analysed(options);
    const PictureOptions& pictures = options.pictures;
    const RayGridDesc grid = options.grid.desc(options.common);
    const Stopwatch start;
    const Centroid result = [&] {
        samples::Progress progress("centroid", std::uint64_t{grid.side} * grid.side, options.common.quiet);
        return centroid(*analysed.accel, analysed.scene,
                        {.grid = grid,
                         .keeps_points = !options.output.empty() || !pictures.files.empty(),
                         .progress = [&](std::uint64_t rays) { progress.advance(rays); }});
    }();
    const double seconds = start.seconds();
    if (!options.output.empty()) write(options.output, result, analysed.scene.origin);
    if (!pictures.files.empty())
        write_pictures(pictures, *analysed.accel, analysed.scene, picture_of(options, analysed, result));
    if (!options.common.quiet) print(options, analysed, result, seconds);
    std::optional<dvec3> mean = result.mean;
    if (mean) *mean += analysed.scene.origin;
    nlohmann::json record = {{"n", result.ray_count},
                             {"points_hit", result.point_count},
                             {"mean", list_or_null(mean)},
                             {"standard_error", list_or_null(result.standard_error)},
                             {"seconds", seconds}};
    record.update(options.grid.record());
    record.update(analysed.record("twinray-centroid/1", options));
    append_json(options.common.json, record);
}

}  // namespace

Command centroid_command() {
    const auto options = std::make_shared<CentroidOptions>();
    Section rays = {"Rays", ray_grid_options(options->grid)};
    rays.options.front().is_required = true;
    return {.name = "centroid",
            .group = "Analyses",
            .summary = "find the mean of the points that are visible along a direction",
            .description =
                "Sends parallel rays over the whole scene, one through each cell of a grid, and averages the points "
                "that they hit.",
            .positionals = {scene_argument(options->scene)},
            .sections = {rays, analysis_output(*options, "write the hit points as CSV: x,y,z"),
                         picture_options(options->pictures,
                                         "nothing; the .png marks the points that rays hit and their mean"),
                         common_options(options->common)},
            .examples = {{"twinray centroid statue.ply --direction 0 0 -1",
                          "the mean visible point for a viewer who looks along -z"}},
            .run = done_after([options] { run(*options); })};
}

}  // namespace twinray::cli
