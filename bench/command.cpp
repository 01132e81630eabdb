// `twinray bench` of a scene: times and errors of every backend, and how they grow with the number of triangles; and of
// instances that a kernel moves.
#include "bench/command.h"

#include <algorithm>
#include <iomanip>

#include <twinray/tlas.h>

#include "bench/report.h"
#include "engine/core/error.h"
#include "engine/core/statistics.h"
#include "engine/core/commands.h"
#include "samples/support/progress.h"
#include "validation/records/recorder.h"

namespace twinray::bench {
namespace {

// The devices and the backends that run on them.
struct Setup {
    std::unique_ptr<Context> context, pipeline;  // the latter is null where the former needs the pipeline itself
    LineUp line_up;
};

Setup set_up(const Session& session) {
    Setup setup;
    ContextDesc desc = session.device;
    setup.context = std::make_unique<Context>(desc);
    const DeviceProperties& properties = setup.context->properties();
    if (properties.ray_query && properties.ray_tracing_pipeline) {
        desc.use_ray_query = false;
        setup.pipeline = std::make_unique<Context>(desc);
    }
    const LineUpOptions& line_up = session.run.line_up;
    setup.line_up = make_line_up(*setup.context, setup.pipeline.get(), line_up);
    if (line_up.has_embree && !session.run.quiet && !why_no_embree().empty())
        session.out << "  " << why_no_embree() << '\n';
    return setup;
}

// The figures of one backend on one scene, in ns but for build_ms; NaN if not measured.
struct GrowthPoint {
    std::size_t triangles = 0;
    double build_ms = NAN;
    double build = NAN;                      // per triangle
    double primary = NAN, incoherent = NAN;  // per ray
};

struct RayColumn {
    const char* field;
    const char* heading;
    double GrowthPoint::*value;
};
constexpr RayColumn ray_columns[] = {{"primary_ns_per_ray", "primary ns/ray", &GrowthPoint::primary},
                                     {"incoherent_ns_per_ray", "incoherent ns/ray", &GrowthPoint::incoherent}};

double median_ns(const Measured& measured, RayKind kind, std::size_t backend) {
    const auto traces = measured.traces.find(kind);
    return traces == measured.traces.end() ? NAN : spread_of(traces->second[backend].ns_per_ray).median;
}

std::vector<double> values_of(std::span<const GrowthPoint> points, double GrowthPoint::*value) {
    std::vector<double> values;
    for (const GrowthPoint& point : points) values.push_back(point.*value);
    return values;
}

std::vector<double> sizes_of(std::span<const GrowthPoint> points) {
    std::vector<double> sizes;
    for (const GrowthPoint& point : points) sizes.push_back(static_cast<double>(point.triangles));
    return sizes;
}

// Fits a line over log2 of the sizes. Returns nothing for fewer than two sizes, or if a point was not measured.
std::optional<Line> line_of(std::span<const GrowthPoint> points, const RayColumn& column) {
    std::vector<double> x = sizes_of(points);
    const std::vector<double> y = values_of(points, column.value);
    for (double& size : x) size = std::log2(size);
    const bool is_measured = std::ranges::all_of(y, [](double value) { return std::isfinite(value); });
    if (!is_measured || x.front() == x.back()) return std::nullopt;
    return fit_line(x, y);
}

std::optional<PowerLaw> build_power_of(std::span<const GrowthPoint> points) {
    return fit_power_law(sizes_of(points), values_of(points, &GrowthPoint::build_ms));
}

GrowthPoint growth_point(const BenchScene& scene, const Measured& measured, std::size_t backend) {
    GrowthPoint point{.triangles = count_mesh_triangles(scene.scene)};
    if (const std::vector<double>& ms = measured.builds[backend].ms; !ms.empty()) {
        point.build_ms = spread_of(ms).median;
        point.build = point.build_ms * 1e6 / static_cast<double>(point.triangles);
    }
    point.primary = median_ns(measured, RayKind::primary, backend);
    point.incoherent = median_ns(measured, RayKind::incoherent, backend);
    return point;
}

// Prints a row for each point, then how times grow with the number n of triangles, by least squares: builds with a
// power of n, rays with log2 n (what each doubling adds).
void print_growth(std::ostream& out, const std::string& backend, std::span<const GrowthPoint> points) {
    std::vector<std::vector<std::string>> rows = {{backend, "build ms", "ns/triangle"}};
    for (const RayColumn& column : ray_columns) rows.back().emplace_back(column.heading);
    for (const GrowthPoint& point : points) {
        rows.push_back({std::to_string(point.triangles) + " triangles", number_text(point.build_ms, 3),
                        number_text(point.build, 3)});
        for (const RayColumn& column : ray_columns) rows.back().push_back(number_text(point.*column.value, 3));
    }
    const std::optional<PowerLaw> power = build_power_of(points);
    rows.push_back({"growth", power ? "n^" + fixed_text(power->slope, 2) : "-", ""});
    for (const RayColumn& column : ray_columns) {
        const std::optional<Line> line = line_of(points, column);
        rows.back().push_back(line ? number_text(line->slope, 3) + " a doubling" : "-");
    }
    print_table(out, rows);
}

// Returns the growth alone, added to the fields of `base`.
nlohmann::json growth_record(const nlohmann::json& base, const Labels& labels, std::span<const GrowthPoint> points) {
    nlohmann::json growth = {{"build_ms", nullptr}};
    if (const std::optional<PowerLaw> power = build_power_of(points)) growth["build_ms"] = {{"power", power->slope}};
    for (const RayColumn& column : ray_columns) {
        growth[column.field] = nullptr;
        if (const std::optional<Line> line = line_of(points, column))
            growth[column.field] = {{"offset", line->offset}, {"per_doubling", line->slope}};
    }
    nlohmann::json record = base;
    record.update({{"schema", record_schema},
                   {"contestant", labels.name},
                   {"backend", labels.backend},
                   {"layout", labels.layout},
                   {"builder", labels.builder},
                   {"level", labels.level},
                   {"triangles_from", points.front().triangles},
                   {"triangles_to", points.back().triangles},
                   {"growth", growth}});
    return record;
}

// Medians of the GPU's times.
struct MoveTimes {
    double refit_ms = 0, rebuild_ms = 0;
};

// Returns transforms that place instances in a cube, each `phase` along its way.
std::vector<Transform> placed(std::size_t count, float phase) {
    const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    std::vector<Transform> transforms;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 cell(i % side, i / side % side, i / side / side);
        const float turn = phase + 0.37f * static_cast<float>(i % 17);
        transforms.push_back(Transform::translation(3.0f * cell + vec3(std::sin(turn), std::cos(turn), 0)));
    }
    return transforms;
}

// Measures `count` instances of a sphere in an empty accelerator. Their transforms come from device memory.
MoveTimes measure_moves(AbstractAccel& accel, std::size_t count, std::size_t rounds) {
    const AccelHandle handle = accel.push(make_icosphere(1), placed(count, 0));
    accel.push(make_icosphere(1));
    accel.sync();
    accel.set_rebuild_ratio(INFINITY);  // refits and rebuilds are requested separately
    std::vector<double> refits, rebuilds;
    for (std::size_t round = 0; round < rounds + 2; ++round) {
        const std::vector<Transform> transforms = placed(count, 0.1f * static_cast<float>(round));
        const Buffer moves = uploaded(accel.context(), "moves", std::span<const Transform>(transforms));
        accel.update_transforms(handle, moves.ref<Transform>(), count);
        const double refit = sync_ms(accel);
        accel.update_transforms(handle, moves.ref<Transform>(), count);
        accel.push(Mesh{});  // a change of structure
        const double rebuild = sync_ms(accel);
        if (round < 2) continue;  // the first move rebuilds
        refits.push_back(refit);
        rebuilds.push_back(rebuild);
    }
    return {median(refits), median(rebuilds)};
}

void tell_moves(const Session& session, AbstractAccel& accel, std::size_t count) {
    const auto [refit_ms, rebuild_ms] = measure_moves(accel, count, session.run.rounds);
    session.out << "  " << std::left << std::setw(8) << accel.name() << std::right << std::fixed << std::setprecision(2)
                << " refit " << std::setw(8) << refit_ms << " ms, rebuild " << std::setw(8) << rebuild_ms << " ms, "
                << refit_ms / rebuild_ms << " of it\n";
    session.record({{"schema", record_schema},
                    {"device", describe(accel.context())},
                    {"rays", "none"},
                    {"backend", accel.is_software() ? "sw" : "hw"},
                    {"instances", count},
                    {"rounds", session.run.rounds},
                    {"refit_ms", refit_ms},
                    {"rebuild_ms", rebuild_ms}});
}

}  // namespace

nlohmann::json base_record(const Session& session) {
    return {{"started", utc_now()}, {"git", session.version}, {"width", session.run.width}, {"seed", session.run.seed}};
}

nlohmann::json base_record(const Session& session, const Context& context) {
    nlohmann::json base = base_record(session);
    base["device"] = describe(context);
    return base;
}

Measured measure(Context& context, LineUp& line_up, const BenchScene& scene, const RunOptions& options) {
    const std::size_t build_rounds = options.times_builds ? options.rounds : 0;
    samples::Progress progress("bench " + scene.name,
                               line_up.size() * (build_rounds + 1 + options.kinds.size() * (options.rounds + 1)),
                               options.quiet);
    const Step step = [&] { progress.advance(); };

    auto rays = make_rays(context, scene, options.width, options.seed);
    std::optional<HitCheck> hit_check;
    if (count_mesh_triangles(scene.scene) <= most_checked_triangles) hit_check.emplace(scene.scene);

    Measured measured;
    measured.builds = measure_builds(line_up, scene.scene, build_rounds, step);
    for (const RayKind kind : options.kinds) {
        const RayBatch batch(std::move(rays[static_cast<std::size_t>(kind)]), query_of(kind), kind == RayKind::primary);
        measured.traces[kind] = measure_traces(
            line_up, batch, {options.rounds, options.max_seconds * 1e3, hit_check ? &*hit_check : nullptr}, step);
    }
    return measured;
}

void bench_scene(const Session& session, const BenchScene& scene) {
    Setup setup = set_up(session);
    const RunOptions& run = session.run;
    session.out << "bench " << scene.name << ": " << count_triangles(scene.scene) << " triangles, "
                << run.width * run.width << " rays per set, medians of " << run.rounds << " interleaved rounds, on "
                << setup.context->properties().name << '\n';
    const Measured measured = measure(*setup.context, setup.line_up, scene, run);
    const Results results{scene, setup.line_up, measured.builds};
    if (run.times_builds) print_builds(session.out, results);
    for (const auto& [kind, traces] : measured.traces) {
        session.out << '\n';
        print_traces(session.out, results, name_of(kind), traces);
    }
    const nlohmann::json base = base_record(session, *setup.context);
    for (const auto& [kind, traces] : measured.traces) record_traces(session.record, base, results, kind, traces);
}

void bench_growth(const Session& session, std::span<const double> sizes) {
    Setup setup = set_up(session);
    session.out << "bench: growth with the number of triangles of displaced spheres, medians of " << session.run.rounds
                << " interleaved rounds, on " << setup.context->properties().name << '\n';
    const nlohmann::json base = base_record(session, *setup.context);
    std::vector<std::vector<GrowthPoint>> points(setup.line_up.size());
    for (const double size : sizes) {
        const BenchScene scene = make_scene(text("sphere:", std::llround(size)));
        const Measured measured = measure(*setup.context, setup.line_up, scene, session.run);
        for (const auto& [kind, traces] : measured.traces)
            record_traces(session.record, base, {scene, setup.line_up, measured.builds}, kind, traces);
        for (std::size_t i = 0; i < points.size(); ++i) points[i].push_back(growth_point(scene, measured, i));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        session.out << '\n';
        print_growth(session.out, setup.line_up[i]->labels().name, points[i]);
        session.record(growth_record(base, setup.line_up[i]->labels(), points[i]));
    }
}

void bench_moves(const Session& session, std::size_t count) {
    Context context(session.device);
    session.out << "bench: " << count << " instances moved from device memory, GPU times, median of "
                << session.run.rounds << " rounds, on " << context.properties().name << '\n';
    SwTlas software(context);
    tell_moves(session, software, count);
    if (!missing_for_hardware(context.properties()).empty()) return;
    HwTlas hardware(context);
    tell_moves(session, hardware, count);
}

}  // namespace twinray::bench
