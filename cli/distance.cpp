// SPDX-License-Identifier: MIT
// `twinray distance`: what of a scene is near to points.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>

#include "cli/distance_slice.h"
#include "cli/npz.h"
#include "cli/picture_options.h"
#include "cli/places.h"
#include "cli/query_points.h"
#include "engine/core/error.h"
#include "engine/points/point_finder.h"

namespace twinray::cli {
namespace {

struct DistanceOptions {
    CommonOptions common;
    std::filesystem::path scene, output;
    QueryPointOptions points;
    SliceOptions slice;
    bool is_signed = false;
    double max_distance = PointFinder::unlimited;
    std::optional<double> within;
};

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

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
        const dvec3 place = origin + of.position;
        out << i << ',';
        if (of.is_found)
            out << of.distance << ',' << place.x << ',' << place.y << ',' << place.z << ',' << of.instance << ','
                << of.triangle << '\n';
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
    PointFinder finder;
    double build_seconds = 0;

    explicit Search(const DistanceOptions& options)
        : scene(load_scene_with_warnings(options.scene, options.common.quiet)),
          context(make_context(options.common)),
          points(options.points.make(scene, options.common.seed)),
          finder(*context) {
        const Clock::time_point start = Clock::now();
        finder.set(scene);
        context->wait_for_gpu();
        build_seconds = seconds_since(start);
    }
    nlohmann::json record(const DistanceOptions& options, double seconds) const {
        return {{"schema", "twinray-distance/1"},       {"device", describe(*context)},
                {"scene", options.scene.string()},      {"origin", list_of(scene.origin)},
                {"triangles", finder.triangle_count()}, {"n", points.size()},
                {"build_seconds", build_seconds},       {"seconds", seconds}};
    }
    void print(double seconds) const {
        std::cout << points.size() << " points, " << finder.triangle_count() << " triangles: built in " << build_seconds
                  << " s, searched in " << seconds << " s with copies, "
                  << static_cast<double>(points.size()) / seconds / 1e6 << " million a second\n";
    }
};

void run_within(const DistanceOptions& options, Search& search) {
    const Clock::time_point start = Clock::now();
    const std::vector<NearTriangle> near = search.finder.within(search.points, *options.within);
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
    const Clock::time_point start = Clock::now();
    std::vector<ClosestPoint> found = search.finder.closest(search.points, options.max_distance);
    std::size_t inside = 0;
    if (options.is_signed) {
        const std::vector<int> windings = search.finder.winding_numbers(search.points);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (windings[i] == 0) continue;
            ++inside;
            found[i].distance = -found[i].distance;
        }
    }
    const double seconds = seconds_since(start);
    if (options.output.extension() == ".npz")
        write_npz(options, search.points, found, search.scene.origin);
    else if (!options.output.empty())
        write_csv(options.output, found, search.scene.origin);
    const auto near =
        std::count_if(found.begin(), found.end(), [](const ClosestPoint& point) { return point.is_found; });
    if (!options.common.quiet) {
        search.print(seconds);
        std::cout << near << " have a nearest triangle";
        if (options.is_signed)
            std::cout << ", " << inside << " are inside; " << search.finder.host_decided()
                      << " crossings that float64 could not decide";
        std::cout << '\n';
    }
    nlohmann::json record = search.record(options, seconds);
    record.update({{"query", options.is_signed ? "signed" : "closest"}, {"found", near}, {"inside", inside}});
    append_json(options.common.json, record);
}

void run(const DistanceOptions& options) {
    if (!options.points.is_asked_for() && options.slice.file.empty())
        throw CLI::RequiredError("--points, --random, --grid or --slice");
    if (!options.output.empty()) check_writable(options.output);
    if (!options.slice.file.empty()) check_png(options.slice.file);
    const std::string suffix = options.output.extension().string();
    if (suffix != "" && suffix != ".csv" && suffix != ".npz")
        fail("'", options.output.string(), "': distances go into .csv or .npz");
    if (options.within && suffix == ".npz")
        fail("'", options.output.string(), "': what is within a radius goes into .csv");
    if (options.within && !options.slice.file.empty()) fail("--slice shows distances, not what is within a radius");
    Search search(options);
    if (options.points.is_asked_for()) options.within ? run_within(options, search) : run_closest(options, search);
    if (!options.slice.file.empty())
        write_slice(options.slice, search.scene, search.finder, options.is_signed,
                    options.scene.filename().string() + ": distances");
}

}  // namespace

void add_distance(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand("distance", "what of a scene is near to points, and how far away");
    const auto options = std::make_shared<DistanceOptions>();
    command->add_option("scene", options->scene, ".gltf, .glb, .obj, .ply or .stl")->required();
    add_query_point_options(*command, options->points);
    add_slice_options(*command, options->slice);
    command->add_option("-o,--output", options->output,
                        "CSV of point,distance,x,y,z,instance,triangle, or .npz with the points, too");
    CLI::Option* sign = command->add_flag("--signed", options->is_signed,
                                          "negative inside; needs closed meshes whose fronts look outward");
    CLI::Option* limit = command->add_option("--max-distance", options->max_distance, "nothing is looked for beyond it")
                             ->check(CLI::NonNegativeNumber)
                             ->excludes(sign);
    command
        ->add_option("--within", options->within,
                     "instead, all triangles that are at most so far away: CSV of point,instance,triangle,distance")
        ->check(CLI::NonNegativeNumber)
        ->excludes(sign)
        ->excludes(limit);
    add_common_options(*command, options->common);
    command->callback([options] { run(*options); });
}

}  // namespace twinray::cli
