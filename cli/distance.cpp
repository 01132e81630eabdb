// `twinray distance`: the parts of a scene that are near points, as a table or as a picture of a plane.
#include <twinray/queries.h>

#include <random>

#include "cli/csv_files.h"
#include "cli/shards.h"
#include "engine/analysis/npz.h"
#include "engine/core/stopwatch.h"
#include "engine/core/files.h"
#include "twinray/glsl/cpp.h"
#include "twinray/glsl/vector_math.h"
#include "viewer/picture/page.h"

namespace twinray::cli {
namespace {

constexpr std::uint64_t most_cells = 640;

// The box of the scene, grown by a tenth of its largest side on all sides.
struct QueryBox {
    dvec3 lo, size;
};
// Throws Error if there is no triangle.
QueryBox query_box(const Scene& scene) {
    const Bounds bounds = bounds_of(scene);
    if (bounds.is_empty())
        fail("distance: the scene has no triangles, so there is no box for --random, --grid or --slice");
    const dvec3 lo(bounds.lo), hi(bounds.hi), size = hi - lo;
    const double margin = 0.1 * std::max({size.x, size.y, size.z});
    return {lo - margin, size + 2 * margin};
}

struct DistanceOptions {
    CommonOptions common;
    ShardOptions shards;
    std::filesystem::path scene, output;
    std::filesystem::path points;  // or `random` points, or a grid with `grid` of them along each side
    std::uint64_t random = 0, grid = 0;
    std::filesystem::path slice;  // .png; empty: none
    SliceDesc slice_desc = {};    // in the file's coordinates
    bool is_signed = false;
    double max_distance = PointQuery::unlimited;
    std::optional<double> within;

    bool has_points() const { return !points.empty() || random > 0 || grid > 0; }
};

// Returns the points of the file, or points in query_box(): random ones, or the centres of a grid's cells, x fastest.
// Returns none if none were asked for. Throws Error naming the file and the line.
std::vector<dvec3> points_of(const DistanceOptions& options, const Scene& scene) {
    if (!options.points.empty()) return read_points(options.points, scene.origin);
    if (!options.has_points()) return {};
    const QueryBox box = query_box(scene);
    std::vector<dvec3> points;
    if (options.random > 0) {
        std::mt19937_64 generator(options.common.seed);
        const auto unit = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
        for (std::uint64_t i = 0; i < options.random; ++i) {
            const double x = unit(), y = unit();
            points.push_back(box.lo + box.size * dvec3(x, y, unit()));
        }
        return points;
    }
    const std::uint64_t grid = options.grid;
    const dvec3 cell = box.size / static_cast<double>(grid);
    for (std::uint64_t i = 0; i < grid * grid * grid; ++i) {
        const dvec3 index(static_cast<double>(i % grid), static_cast<double>(i / grid % grid),
                          static_cast<double>(i / (grid * grid)));
        points.push_back(box.lo + cell * (index + 0.5));
    }
    return points;
}

bool is_npz(const std::filesystem::path& file) { return lower_suffix(file) == ".npz"; }

void write_csv(const std::filesystem::path& file, const std::vector<ClosestPoint>& found, const dvec3& origin) {
    write_table(file, "point,distance,x,y,z,instance,triangle", found, [&](std::ostream& out, const ClosestPoint& of) {
        const dvec3 point_in_file = origin + of.position;
        out << &of - found.data() << ',';
        if (of.is_found)
            out << of.distance << ',' << point_in_file.x << ',' << point_in_file.y << ',' << point_in_file.z << ','
                << of.instance << ',' << of.triangle << '\n';
        else
            out << "inf,,,,,\n";
    });
}

void write_csv(const std::filesystem::path& file, const std::vector<NearTriangle>& near) {
    write_table(file, "point,instance,triangle,distance", near, [](std::ostream& out, const NearTriangle& each) {
        out << each.point << ',' << each.instance << ',' << each.triangle << ',' << each.distance << '\n';
    });
}

// Writes arrays by point; a grid's are distance[z, y, x].
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
    const std::size_t n = points.size(), side = options.grid;
    Npz npz;
    npz.add("distance", std::span<const double>(distance),
            side > 0 ? std::vector<std::size_t>{side, side, side} : std::vector<std::size_t>{});
    npz.add("point", std::span<const double>(from), {n, 3});
    npz.add("nearest", std::span<const double>(at), {n, 3});
    npz.add("instance", std::span<const std::uint32_t>(instance));
    npz.add("triangle", std::span<const std::uint32_t>(triangle));
    npz.write(options.output);
}

// A search, with the data of every record.
struct Search {
    Scene scene;
    std::unique_ptr<Context> context;
    std::vector<dvec3> points;
    PointQuery query;
    double build_seconds = 0;

    explicit Search(const DistanceOptions& options)
        : scene(load_scene(options.scene, options.common)),
          context(make_context(options.common)),
          points(points_of(options, scene)),
          query(*context) {
        const Stopwatch start;
        query.set(scene);
        context->wait_for_gpu();
        build_seconds = start.seconds();
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

Agreement agreement_for(const DistanceOptions& options, const Search& search) {
    return agreement_of("distance", search.scene, "",
                        {{"points", checksum_text(std::as_bytes(std::span(search.points)))},
                         {"--signed", options.is_signed ? "yes" : "no"},
                         {"--max-distance", text(std::hexfloat, options.max_distance)},
                         {"--within", options.within ? text(std::hexfloat, *options.within) : "no"}});
}

std::span<const dvec3> points_in(const Search& search, Rows rows) {
    return std::span(search.points).subspan(rows.first, rows.count());
}

void run_within(const Shards& shards, const DistanceOptions& options, Search& search) {
    const Stopwatch start;
    const auto found =
        compute_rows<NearTriangle>(shards, search.points.size(), agreement_for(options, search), [&](Rows rows) {
            std::vector<NearTriangle> near = search.query.within(points_in(search, rows), *options.within);
            for (NearTriangle& each : near) each.point += static_cast<uint>(rows.first);
            return near;
        });
    if (!found) return;
    const std::vector<NearTriangle>& near = *found;
    const double seconds = start.seconds();
    write_csv(options.output, near);
    if (!options.common.quiet) {
        search.print(seconds);
        std::cout << near.size() << " triangles within " << *options.within << '\n';
    }
    nlohmann::json record = search.record(options, seconds);
    record.update({{"query", "within"}, {"radius", *options.within}, {"found", near.size()}});
    append_json(options.common.json, record);
}

// With --signed, distances inside are below 0, or -0.
std::vector<ClosestPoint> closest(const DistanceOptions& options, Search& search, Rows rows) {
    std::vector<ClosestPoint> found = search.query.closest(points_in(search, rows), options.max_distance);
    if (!options.is_signed) return found;
    const std::vector<int> windings = search.query.winding_numbers(points_in(search, rows));
    for (std::size_t i = 0; i < found.size(); ++i)
        if (windings[i] != 0) found[i].distance = -found[i].distance;
    return found;
}

void run_closest(const Shards& shards, const DistanceOptions& options, Search& search) {
    const Stopwatch start;
    const auto computed = compute_rows<ClosestPoint>(shards, search.points.size(), agreement_for(options, search),
                                                     [&](Rows rows) { return closest(options, search, rows); });
    if (!computed) return;
    const std::vector<ClosestPoint>& found = *computed;
    const auto inside = std::ranges::count_if(
        found, [](double distance) { return std::signbit(distance); }, &ClosestPoint::distance);
    const double seconds = start.seconds();
    if (is_npz(options.output))
        write_npz(options, search.points, found, search.scene.origin);
    else
        write_csv(options.output, found, search.scene.origin);
    const auto near = std::ranges::count_if(found, &ClosestPoint::is_found);
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

// Throws Error for a scene without triangles. With --signed, values are negative inside, as signed_distances() says.
void write_slice(const DistanceOptions& options, Search& search) {
    const dvec3& origin = search.scene.origin;
    const QueryBox box = query_box(search.scene);
    SliceDesc desc = options.slice_desc;
    const int normal = desc.axis - 'x';
    if (desc.at) *desc.at -= origin[normal];
    const Slice slice = slice_of(desc, box.lo, box.size);
    std::vector<double> values;
    if (options.is_signed)
        values = search.query.signed_distances(slice.points);
    else
        for (const ClosestPoint& found : search.query.closest(slice.points)) values.push_back(found.distance);
    const ValueScale scale = ValueScale::linear_for(values);
    const std::string at = coordinate_text(slice.points.front()[normal], origin[normal]);
    const Raster page =
        compose(draw_slice(slice, values, scale),
                {.title = options.scene.filename().string() + ": distances",
                 .subtitle = text("plane ", desc.axis, " = ", at),
                 .legend = {.title = options.is_signed ? "signed" : "distance", .scale = scale, .entries = {}}});
    write_png(options.slice, page.width, page.height, page.pixels);
}

void run(DistanceOptions options) {
    if (!options.has_points() && options.slice.empty())
        throw UsageError("one of --points, --random, --grid, --slice is required");
    check_writable(options.output);
    check_writable(options.slice);
    if (options.within && is_npz(options.output))
        throw UsageError(text("--output is '", options.output.string(), "', but --within writes .csv"));
    const Shards shards(options.shards, options.common, options.output);
    if (!shards.is_whole() && !options.has_points())
        throw UsageError("one of --points, --random, --grid is required: their rows are shared");
    Search search(options);
    if (options.has_points())
        options.within ? run_within(shards, options, search) : run_closest(shards, options, search);
    if (!options.slice.empty()) write_slice(options, search);
}

// Returns --points, --random and --grid; at most one of them may be given.
std::vector<Option> query_point_options(DistanceOptions& options) {
    return {
        {.name = "--points",
         .value = file(options.points),
         .help = "read the points from this file, one x,y,z per line"},
        {.name = "--random",
         .value = number(options.random, {1, most_points}),
         .help =
             "generate N random points in the box of the scene, enlarged by a tenth of its largest side on all sides"},
        {.name = "--grid",
         .value = number(options.grid, {1, most_cells}),
         .help = "use the centres of N x N x N cells of that box; x varies fastest"}};
}

Section slice_options(DistanceOptions& options) {
    const Names<char> axes = {{"x", 'x'}, {"y", 'y'}, {"z", 'z'}};
    return {"Slice",
            {{.name = "--slice",
              .value = file(options.slice, {".png"}),
              .help = "write a picture of the distances in a plane through the scene"},
             {.name = "--slice-axis",
              .value = choice(options.slice_desc.axis, axes),
              .help = "axis perpendicular to the plane",
              .needs = {"--slice"}},
             {.name = "--slice-at",
              .value = number(options.slice_desc.at),
              .help = "position of the plane on that axis; without it, the middle of the scene",
              .needs = {"--slice"}},
             {.name = "--slice-size",
              .value = number(options.slice_desc.width, {16, 4096}),
              .help = "pixels along the longer side",
              .needs = {"--slice"}}}};
}

}  // namespace

Command distance_command() {
    const auto options = std::make_shared<DistanceOptions>();
    const Section search = {
        "Search",
        {{.name = "--signed",
          .value = flag(options->is_signed),
          .help = "make distances negative inside; the meshes must be closed and their fronts must face outward"},
         {.name = "--max-distance",
          .value = number(options->max_distance, {.least = 0}),
          .help = "do not search beyond this distance",
          .excludes = {"--signed"}},
         {.name = "--within",
          .value = number(options->within, {.least = 0}),
          .help = "find all triangles within this distance, instead of the nearest",
          .excludes = {"--signed", "--max-distance", "--slice"}},
         output_option(file(options->output, {".csv", ".npz"}),
                       "write for each point its number, distance, nearest position, instance and triangle; with "
                       "--within, only as .csv: point, instance, triangle, distance")}};
    return {.name = "distance",
            .group = "Analyses",
            .summary = "find the nearest triangles to points, and their distances",
            .description =
                "Finds the nearest triangle of each point, or all triangles within a radius, in float64. With --signed "
                "it also determines exactly whether each point is inside or outside.",
            .positionals = {scene_argument(options->scene)},
            .sections = {{"Points", query_point_options(*options)},
                         search,
                         slice_options(*options),
                         shard_options(options->shards, {"--slice"}),
                         common_options(options->common)},
            .alternatives = {{.names = {"--points", "--random", "--grid"}}},
            .examples = {{"twinray distance part.stl --points probes.csv --signed -o distances.csv",
                          "depth of each probe inside a part, or its distance outside"}},
            .run = done_after([options] { run(*options); })};
}

}  // namespace twinray::cli
