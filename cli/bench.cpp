// SPDX-License-Identifier: MIT
// `twinray bench`: build times and trace rates of both accelerators beside others, with their errors.
#include <cmath>
#include <iostream>

#include "bench/embree_contestant.h"
#include "bench/growth.h"
#include "bench/report.h"
#include "bench/run.h"
#include "cli/common.h"
#include "engine/core/error.h"
#include "engine/report/recorder.h"
#include "twinray_version.h"

namespace twinray::cli {
namespace {

using bench::BenchScene;
using bench::LineUp;
using bench::Measured;
using bench::RayKind;

struct BenchOptions {
    CommonOptions common;
    bench::RunOptions run;
    std::string scene;
    std::vector<RayKind> kinds;
    std::vector<double> growth = {1e3, 1e4, 1e5, 1e6, 1e7};
    std::size_t moves = 0;
    bool no_embree = false, no_build = false, is_ladder = false;
};

// The devices and who runs on them.
struct Setup {
    std::unique_ptr<Context> context, pipeline;  // the latter is null where the former needs the pipeline itself
    LineUp line_up;
};

Setup set_up(const BenchOptions& options) {
    Setup setup;
    ContextDesc desc = context_desc(options.common);
    setup.context = std::make_unique<Context>(desc);
    const DeviceFacts& facts = setup.context->facts();
    if (facts.ray_query && facts.ray_tracing_pipeline) {
        desc.use_ray_query = false;
        setup.pipeline = std::make_unique<Context>(desc);
    }
    setup.line_up = bench::make_line_up(*setup.context, setup.pipeline.get(), options.run.line_up);
    if (options.run.line_up.has_embree && !options.common.quiet && !bench::why_no_embree().empty())
        std::cout << "  " << bench::why_no_embree() << '\n';
    return setup;
}

nlohmann::json base_record(const BenchOptions& options, const Context& context) {
    return {{"device", describe(context)},
            {"started", utc_now()},
            {"git", twinray_version},
            {"width", options.run.width},
            {"seed", options.common.seed}};
}

BenchScene load(const BenchOptions& options, const std::string& name) {
    BenchScene scene = bench::make_scene(name);
    print_notes(scene.scene, options.common.quiet);
    return scene;
}

void append_records(const BenchOptions& options, const nlohmann::json& base, const bench::Results& results,
                    const Measured& measured) {
    for (const auto& [kind, traces] : measured.traces)
        for (const nlohmann::json& record : bench::records_of(base, results, kind, traces))
            append_json(options.common.json, record);
}

void run(const BenchOptions& options) {
    const BenchScene scene = load(options, options.scene);
    Setup setup = set_up(options);
    std::cout << "bench " << scene.name << ": " << count_triangles(scene.scene) << " triangles, "
              << options.run.width * options.run.width << " rays a set, medians of " << options.run.rounds
              << " interleaved rounds, on " << setup.context->facts().name << '\n';
    const Measured measured = bench::measure(*setup.context, setup.line_up, scene, options.run);
    const bench::Results results{scene, setup.line_up, measured.builds};
    if (options.run.times_builds) bench::print_builds(std::cout, results);
    for (const auto& [kind, traces] : measured.traces) {
        std::cout << '\n';
        bench::print_traces(std::cout, results, name_of(kind), traces);
    }
    append_records(options, base_record(options, *setup.context), results, measured);
}

void run_growth(const BenchOptions& options) {
    Setup setup = set_up(options);
    std::cout << "bench: growth with the number of triangles of displaced spheres, medians of " << options.run.rounds
              << " interleaved rounds, on " << setup.context->facts().name << '\n';
    const nlohmann::json base = base_record(options, *setup.context);
    std::vector<std::vector<bench::GrowthPoint>> points(setup.line_up.size());
    for (const double size : options.growth) {
        const BenchScene scene = load(options, text("sphere:", std::llround(size)));
        const Measured measured = bench::measure(*setup.context, setup.line_up, scene, options.run);
        append_records(options, base, {scene, setup.line_up, measured.builds}, measured);
        for (std::size_t i = 0; i < points.size(); ++i) points[i].push_back(bench::growth_point(scene, measured, i));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::cout << '\n';
        bench::print_growth(std::cout, setup.line_up[i]->labels().name, points[i]);
        append_json(options.common.json, bench::growth_record(base, setup.line_up[i]->labels(), points[i]));
    }
}

std::map<std::string, RayKind> ray_kinds_by_name() {
    std::map<std::string, RayKind> kinds;
    for (const RayKind kind : bench::all_ray_kinds) kinds.emplace(bench::name_of(kind), kind);
    return kinds;
}

std::map<std::string, Level> levels_by_name() {
    std::map<std::string, Level> levels;
    for (const Level level : {Level::fast, Level::watertight, Level::refined, Level::certified})
        levels.emplace(bench::level_name(level), level);
    return levels;
}

std::map<std::string, RayOrder> ray_orders_by_name() {
    std::map<std::string, RayOrder> orders;
    for (const RayOrder order : all_ray_orders) orders.emplace(name_of(order), order);
    return orders;
}

void add_choice_options(CLI::App& command, bench::RunOptions& run) {
    command.add_option("--levels", run.line_up.levels, "fast, watertight, refined, certified; separated by commas")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(levels_by_name()));
    command.add_option("--layouts", run.line_up.layouts, "of SwTlas: compressed4, bvh2, bvh4; separated by commas")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(layouts_by_name()));
    command.add_option("--build-qualities", run.line_up.build_qualities, "of SwTlas: fast, high; separated by commas")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(build_qualities_by_name()));
    command
        .add_option("--ray-orders", run.line_up.ray_orders,
                    "in which accelerators trace: given, sorted; separated by commas")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(ray_orders_by_name()));
    command
        .add_option("--contestants", run.line_up.only,
                    "those with one of these parts in their names, as sw,embree8; separated by commas; else all")
        ->delimiter(',');
}

void add_size_options(CLI::App& command, bench::RunOptions& run) {
    command.add_option("--width", run.width, "pixels a side of the square of primary rays, a multiple of 8")
        ->check(CLI::Range(8, 4096))
        ->check([](const std::string& width) {
            return std::stoul(width) % 8 == 0 ? std::string() : width + " is not a multiple of 8";
        })
        ->capture_default_str();
    command.add_option("--rounds", run.rounds)->check(CLI::Range(1, 1000))->capture_default_str();
    command
        .add_option("--max-seconds", run.max_seconds,
                    "of one trace: whoever needs more traces fewer rays, evenly chosen")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
}

void dispatch(BenchOptions& options, bool is_growth) {
    options.run.seed = options.common.seed;
    options.run.quiet = options.common.quiet;
    options.run.times_builds = !options.no_build;
    options.run.line_up.has_embree = !options.no_embree;
    if (!options.kinds.empty())
        options.run.kinds = options.kinds;
    else if (is_growth)
        options.run.kinds = {RayKind::primary, RayKind::incoherent};
    if (options.moves)
        bench_moves(options.common, options.moves, options.run.rounds);
    else if (options.is_ladder)
        bench_ladder(options.common, options.scene, options.run);
    else if (is_growth)
        run_growth(options);
    else
        run(options);
}

}  // namespace

void add_bench(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand("bench", "build and trace rates of both accelerators, with their errors");
    const auto options = std::make_shared<BenchOptions>();
    auto* what = command->add_option_group("what")->require_option(1);
    CLI::Option* scene =
        what->add_option("--scene", options->scene,
                         "a file (.gltf, .glb, .obj, .ply, .stl), or made: sphere:N, soup:N, instances:KxN, with N "
                         "triangles and K instances");
    what->add_option("--moves", options->moves, "refit of so many instances that move, against a rebuild")
        ->check(CLI::Range(1, 1 << 22));
    const CLI::Option* growth =
        what->add_option("--growth", options->growth, "spheres of so many triangles; separated by commas")
            ->delimiter(',')
            ->expected(0, 100)
            ->check(CLI::Range(20.0, 5e7))
            ->capture_default_str();
    command
        ->add_option("--rays", options->kinds,
                     "primary, incoherent, occlusion, shuffled; separated by commas; else the first three, of growth "
                     "the first two")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(ray_kinds_by_name()));
    add_choice_options(*command, options->run);
    add_size_options(*command, options->run);
    command
        ->add_flag("--ladder", options->is_ladder,
                   "what each feature costs that the scene does not need, on the first layout and level, and what an "
                   "accelerator keeps in memory")
        ->needs(scene);
    command->add_flag("--no-embree", options->no_embree, "leave Embree out");
    command->add_flag("--no-build", options->no_build, "time traces alone; a ladder's, without its memory");
    add_common_options(*command, options->common);
    command->callback([options, growth] { dispatch(*options, growth->count() > 0); });
}

}  // namespace twinray::cli
