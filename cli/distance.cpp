// SPDX-License-Identifier: MIT
// `twinray distance`: what of a scene is near to points.
#include <twinray/queries.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/command/values.h"
#include "cli/commands.h"
#include "cli/common.h"
#include "cli/distance_slice.h"
#include "engine/analysis/npz.h"
#include "cli/query_points.h"
#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "twinray/glsl/cpp.h"

namespace twinray::cli {
namespace {

struct DistanceOptions {
    CommonOptions common;
    std::filesystem::path scene, output;
    QueryPointOptions points;
    SliceOptions slice;
    bool is_signed = false;
    double max_distance = PointQuery::unlimited;
    std::optional<double> within;
};

bool is_npz(const std::filesystem::path& file) { return lower_suffix(file) == ".npz"; }

std::ofstream open_table(const std::filesystem::path& file, const char* header) {
    std::ofstream out(file);
    out.precision(17);
    out << header << '\n';
    return out;
}

void close_table(std::ofstream& out, const std::filesystem::path& file) {
    if (!out.flush()) fail("CSV file '", file.string(), "' cannot be written");
}

void write_csv(const std::filesystem::path& file, const std::vector<ClosestPoint>& found, const dvec3& origin) {
    std::ofstream out = open_table(file, "point,distance,x,y,z,instance,triangle");
    for (std::size_t i = 0; i < found.size(); ++i) {
        const ClosestPoint& of = found[i];
        const dvec3 point_in_file = origin + of.position;
        out << i << ',';
        if (of.is_found)
            out << of.distance << ',' << point_in_file.x << ',' << point_in_file.y << ',' << point_in_file.z << ','
                << of.instance << ',' << of.triangle << '\n';
        else
            out << "inf,,,,,\n";
    }
    close_table(out, file);
}

void write_csv(const std::filesystem::path& file, const std::vector<NearTriangle>& near) {
    std::ofstream out = open_table(file, "point,instance,triangle,distance");
    for (const NearTriangle& each : near)
        out << each.point << ',' << each.instance << ',' << each.triangle << ',' << each.distance << '\n';
    close_table(out, file);
}

// Arrays by point: of a grid, distance[z, y, x].
void write_npz(const DistanceOptions& options, const std::vector<dvec3>& points, const std::vector<ClosestPoint>& found,
               const dvec3& origin) {
    constexpr std::uint32_t none = 0xffffffffu;
    std::vector<double> distance, from, at;
    std::vector<std::uint32_t> instance, triangle;
    for (std::size_t i = 0; i < points.size(); ++i) {
        distance.push_back(found[i].distance);
        for (int axis = 0; axis < 3; ++axis) {
            from.push_back(origin[axis] + points[i][axis]);
            at.push_back(origin[axis] + found[i].position[axis]);
        }
        instance.push_back(found[i].is_found ? found[i].instance : none);
        triangle.push_back(found[i].is_found ? found[i].triangle : none);
    }
    const std::size_t n = points.size(), side = options.points.grid;
    Npz npz;
    npz.add("distance", std::span<const double>(distance),
            side > 0 ? std::vector<std::size_t>{side, side, side} : std::vector<std::size_t>{});
    npz.add("point", std::span<const double>(from), {n, 3});
    npz.add("nearest", std::span<const double>(at), {n, 3});
    npz.add("instance", std::span<const std::uint32_t>(instance));
    npz.add("triangle", std::span<const std::uint32_t>(triangle));
    npz.write(options.output);
}

// Searches, with what every record says.
struct Search {
    Scene scene;
    std::unique_ptr<Context> context;
    std::vector<dvec3> points;
    PointQuery query;
    double build_seconds = 0;

    explicit Search(const DistanceOptions& options)
        : scene(load_scene(options.scene, options.common)),
          context(make_context(options.common)),
          points(options.points.make(scene, options.common.seed)),
          query(*context) {
        const auto start = std::chrono::steady_clock::now();
        query.set(scene);
        context->wait_for_gpu();
        build_seconds = seconds_since(start);
    }
    nlohmann::json record(const DistanceOptions& options, double seconds) const {
        nlohmann::json record = base_record("twinray-distance/1", *context, options.scene, scene);
        record.update({{"triangles", query.triangle_count()},
                       {"n", points.size()},
                       {"build_seconds", build_seconds},
                       {"seconds", seconds}});
        return record;
    }
    void print(double seconds) const {
        std::cout << points.size() << " points, " << query.triangle_count() << " triangles: built in " << build_seconds
                  << " s, searched in " << seconds << " s with copies, "
                  << static_cast<double>(points.size()) / seconds / 1e6 << " million a second\n";
    }
};

void run_within(const DistanceOptions& options, Search& search) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<NearTriangle> near = search.query.within(search.points, *options.within);
    const double seconds = seconds_since(start);
    if (!options.output.empty()) write_csv(options.output, near);
    if (!options.common.quiet) {
        search.print(seconds);
        std::cout << near.size() << " triangles within " << *options.within << '\n';
    }
    nlohmann::json record = search.record(options, seconds);
    record.update({{"query", "within"}, {"radius", *options.within}, {"found", near.size()}});
    append_json(options.common.json, record);
}

void run_closest(const DistanceOptions& options, Search& search) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<ClosestPoint> found = search.query.closest(search.points, options.max_distance);
    std::size_t inside = 0;
    if (options.is_signed) {
        const std::vector<int> windings = search.query.winding_numbers(search.points);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (windings[i] == 0) continue;
            ++inside;
            found[i].distance = -found[i].distance;
        }
    }
    const double seconds = seconds_since(start);
    if (is_npz(options.output))
        write_npz(options, search.points, found, search.scene.origin);
    else if (!options.output.empty())
        write_csv(options.output, found, search.scene.origin);
    const auto near =
        std::count_if(found.begin(), found.end(), [](const ClosestPoint& point) { return point.is_found; });
    if (!options.common.quiet) {
        search.print(seconds);
        std::cout << near << " have a nearest triangle";
        if (options.is_signed)
            std::cout << ", " << inside << " are inside; " << search.query.host_decided()
                      << " crossings that float64 could not decide";
        std::cout << '\n';
    }
    nlohmann::json record = search.record(options, seconds);
    record.update({{"query", options.is_signed ? "signed" : "closest"}, {"found", near}, {"inside", inside}});
    append_json(options.common.json, record);
}

void run(const DistanceOptions& options) {
    if (!options.points.is_asked_for() && options.slice.file.empty())
        throw UsageError("one of --points, --random, --grid, --slice is required");
    check_writable(options.output);
    check_writable(options.slice.file);
    if (options.within && is_npz(options.output))
        throw UsageError(text("--output is '", options.output.string(), "', but --within writes .csv"));
    Search search(options);
    if (options.points.is_asked_for()) options.within ? run_within(options, search) : run_closest(options, search);
    if (!options.slice.file.empty())
        write_slice(options.slice, search.scene, search.query, options.is_signed,
                    options.scene.filename().string() + ": distances");
}

}  // namespace

Command distance_command() {
    const auto options = std::make_shared<DistanceOptions>();
    const Section search = {
        "Search",
        {{.name = "--signed",
          .value = flag(options->is_signed),
          .help = "negative inside; needs closed meshes whose fronts look outward"},
         {.name = "--max-distance",
          .value = number(options->max_distance, {.least = 0}),
          .help = "nothing is looked for beyond it",
          .excludes = {"--signed"}},
         {.name = "--within",
          .value = number(options->within, {.least = 0}),
          .help = "instead of the nearest, all triangles that are at most so far away",
          .excludes = {"--signed", "--max-distance", "--slice"}},
         output_option(file(options->output, {".csv", ".npz"}),
                       "of each point: its number, distance, nearest position, instance and triangle; with --within, "
                       "which is .csv alone: point, instance, triangle, distance")}};
    return {.name = "distance",
            .group = "Analyses",
            .summary = "find what of a scene is near to points, and how far away",
            .description =
                "Finds the nearest triangle of each point, or all triangles within a radius, in float64. "
                "With --signed it tells inside from outside, exactly.",
            .positionals = {scene_argument(options->scene)},
            .sections = {{"Points", query_point_options(options->points)},
                         search,
                         slice_options(options->slice),
                         common_options(options->common)},
            .alternatives = {{.names = {"--points", "--random", "--grid"}}},
            .examples = {{"twinray distance part.stl --points probes.csv --signed -o distances.csv",
                          "how deep probes are inside a part, or how far outside"}},
            .run = [options] {
                run(*options);
                return 0;
            }};
}

}  // namespace twinray::cli
