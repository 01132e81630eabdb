// `twinray visible`: which patches of the sky sensors see.
#include <cmath>

#include "cli/analysis_options.h"
#include "cli/shards.h"
#include "engine/analysis/npz.h"
#include "engine/core/files.h"
#include "engine/scene/importers/words.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::cli {
namespace {

struct VisibleOptions : AnalysisOptions {
    ShardOptions shards;
    std::filesystem::path sensors;
    std::string patches = std::string(sky_names[0]);
    std::vector<double> up = {0, 1, 0};
    float t_near = 0;
};

struct Sensors {
    std::vector<vec3> points, normals;
};

Sensors read_sensors(const std::filesystem::path& file, const dvec3& origin) {
    Sensors sensors;
    read_number_lines(file, "sensor file", "x,y,z,dx,dy,dz", [&](std::span<const double> row, std::size_t) {
        sensors.points.emplace_back(row[0] - origin.x, row[1] - origin.y, row[2] - origin.z);
        sensors.normals.emplace_back(row[3], row[4], row[5]);
    });
    return sensors;
}

// Returns the directions of patches in the scene's axes. North is where -z goes along the ground, or y where the zenith
// is nearer to z.
std::vector<vec3> directions_of(std::span<const SkyPatch> sky, dvec3 up) {
    const double length = twinray::length(up);
    if (!(length > 0) || !std::isfinite(length)) fail("--up must be finite and not 0");
    const dvec3 zenith = up / length;
    const dvec3 ahead = std::abs(zenith.z) < 0.7 ? dvec3(0, 0, -1) : dvec3(0, 1, 0);
    const dvec3 north = normalize(ahead - dot(ahead, zenith) * zenith), east = cross(north, zenith);
    std::vector<vec3> directions;
    for (const SkyPatch& patch : sky) {
        const dvec3& d = patch.direction;
        directions.emplace_back(d.x * east + d.y * north + d.z * zenith);
    }
    return directions;
}

// Returns the light of each sensor's free patches under a uniform sky, in units of the light of a whole hemisphere.
std::vector<double> shares_of(std::span<const std::uint8_t> free, const Sensors& sensors,
                              std::span<const vec3> directions, std::span<const SkyPatch> sky) {
    std::vector<double> shares(sensors.points.size(), 0);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const dvec3 normal = normalize(dvec3(sensors.normals[i]));
        double free_light = 0, all = 0;
        for (std::size_t k = 0; k < sky.size(); ++k) {
            const double light = std::max(dot(normal, dvec3(directions[k])), 0.0) * sky[k].solid_angle;
            all += light;
            free_light += free[i * sky.size() + k] * light;
        }
        shares[i] = all > 0 ? free_light / all : 0;
    }
    return shares;
}

void write(const std::filesystem::path& file, std::span<const std::uint8_t> free, std::span<const double> shares,
           std::span<const vec3> directions, std::span<const SkyPatch> sky) {
    if (lower_suffix(file) == ".csv")
        return write_rows(file, "sensor,free_patches,share", shares.size(), [&](std::size_t i) -> CsvRow {
            const auto row = free.subspan(i * sky.size(), sky.size());
            return {{i, static_cast<std::uint64_t>(std::count(row.begin(), row.end(), 1))}, {shares[i]}};
        });
    std::vector<float> along;
    std::vector<double> angles;
    for (std::size_t k = 0; k < sky.size(); ++k) {
        for (int axis = 0; axis < 3; ++axis) along.push_back(directions[k][axis]);
        angles.push_back(sky[k].solid_angle);
    }
    Npz npz;
    npz.add("visible", free, {shares.size(), sky.size()});
    npz.add("share", shares);
    npz.add("directions", std::span<const float>(along), {sky.size(), 3});
    npz.add("solid_angles", std::span<const double>(angles));
    npz.write(file);
}

// Returns nothing if another process goes on.
std::optional<std::vector<std::uint8_t>> free_patches(const Shards& shards, const VisibleOptions& options,
                                                      const Analysed& analysed, const Sensors& sensors,
                                                      std::span<const vec3> directions) {
    const Agreement agreement = agreement_of("visible", analysed.scene, analysed.choice.name(),
                                             {{"points", checksum_text(std::as_bytes(std::span(sensors.points)))},
                                              {"normals", checksum_text(std::as_bytes(std::span(sensors.normals)))},
                                              {"directions", checksum_text(std::as_bytes(directions))},
                                              {"--t-near", text(std::hexfloat, options.t_near)}});
    return compute_rows<std::uint8_t>(shards, sensors.points.size(), agreement, [&](Rows rows) {
        samples::Progress progress("visible", rows.count() * directions.size(), options.common.quiet);
        return visibility(*analysed.accel, std::span(sensors.points).subspan(rows.first, rows.count()), directions,
                          std::span(sensors.normals).subspan(rows.first, rows.count()),
                          {.t_near = options.t_near, .progress = [&](std::uint64_t n) { progress.advance(n); }});
    });
}

void run(VisibleOptions options) {
    const Shards shards(options.shards, options.common, options.output);
    const Analysed analysed(options);
    const Sensors sensors = read_sensors(options.sensors, analysed.scene.origin);
    const std::vector<SkyPatch> sky = sky_patches(options.patches);
    const std::vector<vec3> directions = directions_of(sky, {options.up[0], options.up[1], options.up[2]});
    const std::uint64_t rays = sensors.points.size() * sky.size();
    const Stopwatch start;
    const auto found = free_patches(shards, options, analysed, sensors, directions);
    if (!found) return;
    const std::vector<std::uint8_t>& free = *found;
    const double seconds = start.seconds();
    const std::vector<double> shares = shares_of(free, sensors, directions, sky);
    if (!options.output.empty()) write(options.output, free, shares, directions, sky);
    double mean = 0;
    for (const double share : shares) mean += share / static_cast<double>(shares.size());
    if (!options.common.quiet)
        std::cout << analysed.head("visible", options) << "  " << speed_text(rays, seconds) << "\n  "
                  << sensors.points.size() << " sensors receive " << mean << " of the light of a uniform sky (mean, "
                  << options.patches << ")\n";
    nlohmann::json record = {{"sensors", sensors.points.size()},
                             {"sky", options.patches},
                             {"n", rays},
                             {"mean_share", mean},
                             {"seconds", seconds}};
    record.update(analysed.record("twinray-visible/1", options));
    append_json(options.common.json, record);
}

}  // namespace

Command visible_command() {
    const auto options = std::make_shared<VisibleOptions>();
    const std::vector<std::string> skies(sky_names.begin(), sky_names.end());
    Section asked = {
        "Sensors and patches",
        {{.name = "--sensors",
          .value = file(options->sensors),
          .help = "sensor file of Radiance, with a line x y z dx dy dz for the position and direction of each sensor",
          .is_required = true},
         {.name = "--patches",
          .value = choice(options->patches, skies),
          .help = "sky subdivision, named after Tregenza or Reinhart; north is along -z, or along y if the zenith is "
                  "nearer to z"},
         {.name = "--up", .value = numbers(options->up, "X Y Z"), .help = "direction of the zenith"},
         {.name = "--t-near",
          .value = number(options->t_near, {.least = 0}),
          .help = "distance from a sensor at which triangles begin to count"}}};
    return {.name = "visible",
            .group = "Analyses",
            .summary = "find the sky patches that each sensor sees",
            .description = "Sends a ray from each sensor to the centre of each sky patch in front of it.",
            .positionals = {scene_argument(options->scene)},
            .sections = {asked,
                         analysis_output(*options,
                                         "write .npz: visible (sensors, patches) of 0 and 1, share, directions, "
                                         "solid_angles; or .csv: sensor, free_patches, share. share is the part of the "
                                         "light of a uniform sky that reaches the sensor, relative to no obstruction"),
                         shard_options(options->shards, {}), common_options(options->common)},
            .examples = {{"twinray visible street.glb --sensors windows.pts --patches reinhart577 -o windows.npz",
                          "visibility of 577 patches from each window"}},
            .run = done_after([options] { run(*options); })};
}

}  // namespace twinray::cli
