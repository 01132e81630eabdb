// SPDX-License-Identifier: MIT
#include "bench/command.h"

#include <algorithm>
#include <cmath>
#include <iomanip>

#include "bench/embree_backend.h"
#include "bench/feature_costs.h"
#include "bench/growth.h"
#include "bench/keeping.h"
#include "bench/moves.h"
#include "bench/report.h"
#include "bench/trees.h"
#include "engine/core/error.h"
#include <twinray/tlas.h>
#include "validation/records/recorded_device.h"
#include "validation/records/recorder.h"

namespace twinray::bench {
namespace {

// The devices and who runs on them.
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

// Fields of every record.
nlohmann::json base_record(const Session& session) {
    return {{"started", utc_now()}, {"git", session.version}, {"width", session.run.width}, {"seed", session.run.seed}};
}

nlohmann::json base_record(const Session& session, const Context& context) {
    nlohmann::json base = base_record(session);
    base["device"] = describe(context);
    return base;
}

void record_all(const Session& session, const std::vector<nlohmann::json>& records) {
    for (const nlohmann::json& record : records) session.record(record);
}

void record_traces(const Session& session, const nlohmann::json& base, const Results& results,
                   const Measured& measured) {
    for (const auto& [kind, traces] : measured.traces) record_all(session, records_of(base, results, kind, traces));
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

void bench_scene(const Session& session, const BenchScene& scene) {
    Setup setup = set_up(session);
    const RunOptions& run = session.run;
    session.out << "bench " << scene.name << ": " << count_triangles(scene.scene) << " triangles, "
                << run.width * run.width << " rays a set, medians of " << run.rounds << " interleaved rounds, on "
                << setup.context->properties().name << '\n';
    const Measured measured = measure(*setup.context, setup.line_up, scene, run);
    const Results results{scene, setup.line_up, measured.builds};
    if (run.times_builds) print_builds(session.out, results);
    for (const auto& [kind, traces] : measured.traces) {
        session.out << '\n';
        print_traces(session.out, results, name_of(kind), traces);
    }
    record_traces(session, base_record(session, *setup.context), results, measured);
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
        record_traces(session, base, {scene, setup.line_up, measured.builds}, measured);
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

void bench_feature_costs(const Session& session, const BenchScene& scene) {
    const RunOptions& run = session.run;
    Context context(session.device);
    const FeatureCostOptions options{.layout = run.line_up.layouts.front(),
                                     .level = run.line_up.levels.front(),
                                     .rounds = std::max<std::size_t>(run.rounds, 5),
                                     .seed = run.seed,
                                     .width = run.width};
    session.out << "bench " << scene.name << ": features that " << name_of(options.layout) << ' '
                << name_of(options.level) << " does not need, one more in each line, medians of " << options.rounds
                << " interleaved rounds, on " << context.properties().name << '\n';
    nlohmann::json base = base_record(session, context);
    const dvec3& origin = scene.scene.origin;
    base.update({{"scene", scene.name}, {"origin", {origin.x, origin.y, origin.z}}});
    nlohmann::json step_base = base;
    step_base.update({{"layout", name_of(options.layout)}, {"level", name_of(options.level)}});
    bool agree = true;
    for (const FeatureCosts& costs : measure_feature_costs(context, scene, options, run.kinds)) {
        session.out << '\n';
        print_feature_costs(session.out, costs);
        record_all(session, records_of(step_base, costs));
        agree = agree && costs.agrees();
    }
    if (run.times_builds) {
        const std::size_t triangles = std::max<std::size_t>(count_mesh_triangles(scene.scene), 1);
        // Each round builds every one of them: beyond 9 the medians stand.
        const std::vector<Keeping> keepings =
            measure_keepings(context, scene, std::min<std::size_t>(options.rounds, 9));
        session.out << '\n';
        print_keepings(session.out, keepings, triangles);
        record_all(session, records_of(base, keepings, triangles));
    }
    if (!agree) fail("bench: programs with more features than needed found other hits");
}

void bench_trees(const Session& session, const BenchScene& scene) {
    const RunOptions& run = session.run;
    Context context(session.device);
    session.out << "bench " << scene.name << ": trees over " << count_triangles(scene.scene)
                << " triangles as one mesh, " << run.width * run.width
                << " rays a set at level watertight, what a ray takes on average\n";
    const std::vector<TreeFigures> trees = measure_trees(context, scene, run.kinds, run.width, run.seed);
    print_trees(session.out, trees);
    nlohmann::json base = base_record(session);
    base.update({{"scene", scene.name}, {"triangles", count_triangles(scene.scene)}});
    record_all(session, records_of(base, trees));
}

}  // namespace twinray::bench
