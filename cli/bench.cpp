// SPDX-License-Identifier: MIT
// `twinray bench`: build times and trace rates of both accelerators beside others, with their errors.
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "bench/embree_contestant.h"
#include "bench/growth.h"
#include "bench/report.h"
#include "bench/run.h"
#include "cli/bench_kinds.h"
#include "cli/command/values.h"
#include "cli/commands.h"
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
    bool no_embree = false, no_build = false, is_ladder = false, is_trees = false, is_growth = false;
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
    heed_warnings(scene.scene, name, options.common);
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

Section contestants_section(BenchOptions& options) {
    bench::LineUpOptions& line_up = options.run.line_up;
    return {"Contestants",
            {{.name = "--contestants",
              .value = words(line_up.only, "PART,..."),
              .help = "those with one of these parts in their names, as sw,embree8; all if not given"},
             {.name = "--levels", .value = choices(line_up.levels, levels_by_name()), .help = "of the triangle test"},
             {.name = "--layouts",
              .value = choices(line_up.layouts, names_of(all_layouts)),
              .help = "of the software accelerator's trees"},
             {.name = "--build-qualities",
              .value = choices(line_up.build_qualities, names_of(all_build_qualities)),
              .help = "of the software accelerator's trees"},
             {.name = "--ray-orders",
              .value = choices(line_up.ray_orders, names_of(all_ray_orders)),
              .help = "in which accelerators trace"},
             {.name = "--no-embree", .value = flag(options.no_embree), .help = "leave Embree out"},
             {.name = "--no-build",
              .value = flag(options.no_build),
              .help = "time traces alone; a ladder's, without its memory"}}};
}

Section rays_section(BenchOptions& options) {
    bench::RunOptions& run = options.run;
    return {"Rays and rounds",
            {{.name = "--ray-kinds",
              .value = choices(options.kinds, names_of(bench::all_ray_kinds)),
              .help = "kinds of rays; the first three if not given, with --growth the first two",
              .former_name = "--rays"},
             {.name = "--width",
              .value = number(run.width, {.least = 8, .most = 4096, .step = 8}),
              .help = "pixels a side of the square of primary rays, a multiple of 8"},
             {.name = "--rounds", .value = number(run.rounds, {1, 1000}), .help = "of which medians are taken"},
             {.name = "--max-seconds",
              .value = number(run.max_seconds, {.least = 0, .is_above = true}),
              .help = "of one trace: whoever needs more traces fewer rays, evenly chosen"}}};
}

void dispatch(BenchOptions& options) {
    options.run.seed = options.common.seed;
    options.run.quiet = options.common.quiet;
    options.run.times_builds = !options.no_build;
    options.run.line_up.has_embree = !options.no_embree;
    if (!options.kinds.empty())
        options.run.kinds = options.kinds;
    else if (options.is_growth)
        options.run.kinds = {RayKind::primary, RayKind::incoherent};
    if (options.moves)
        bench_moves(options.common, options.moves, options.run.rounds);
    else if (options.is_ladder)
        bench_ladder(options.common, options.scene, options.run);
    else if (options.is_trees)
        bench_trees(options.common, options.scene, options.run);
    else if (options.is_growth)
        run_growth(options);
    else
        run(options);
}

}  // namespace

Command bench_command() {
    const auto options = std::make_shared<BenchOptions>();
    const Section what = {
        "What is measured",
        {{.name = "--scene",
          .value = word(options->scene, "SCENE"),
          .help = "a file (.gltf, .glb, .obj, .ply, .stl), or made: sphere:N, soup:N, instances:KxN, with N triangles "
                  "and K instances"},
         {.name = "--moves",
          .value = number(options->moves, {1, 1 << 22}),
          .help = "refit of so many instances that move, against a rebuild"},
         {.name = "--growth",
          .value = optional_list(options->is_growth, options->growth, {20, 5e7}),
          .help = "spheres of so many triangles, one after the other"},
         {.name = "--ladder",
          .value = flag(options->is_ladder),
          .help = "what each feature costs that the scene does not need, on the first layout and level, and what an "
                  "accelerator keeps in memory",
          .needs = {"--scene"}},
         {.name = "--trees",
          .value = flag(options->is_trees),
          .help = "memory, surface-area cost, end-point overlap and steps a ray of the software accelerator's trees, "
                  "in each layout and build quality: counts, not times",
          .needs = {"--scene"}}}};
    return {.name = "bench",
            .group = "Checking",
            .summary = "measure build times and trace rates of both accelerators, with their errors",
            .description =
                "Builds and traces a scene by both accelerators, and by Embree where it is built in, taking "
                "turns in rounds, and tells medians, ratios within a round, memory, and how often hits "
                "differ from exact ones.",
            .sections = {what, rays_section(*options), contestants_section(*options), common_options(options->common)},
            .alternatives = {{.names = {"--scene", "--moves", "--growth"}, .is_required = true}},
            .examples = {{"twinray bench --scene sphere:100000 --levels watertight,certified",
                          "what certainty costs on a sphere of a hundred thousand triangles"}},
            .run = [options] {
                dispatch(*options);
                return 0;
            }};
}

}  // namespace twinray::cli
