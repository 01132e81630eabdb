// SPDX-License-Identifier: MIT
// `twinray bench`: build times and trace rates of both accelerators beside others, with their errors.
#include <iostream>
#include <nlohmann/json.hpp>

#include "bench/command.h"
#include "cli/command/values.h"
#include "cli/commands.h"
#include "cli/common.h"
#include "twinray_version.h"

namespace twinray::cli {
namespace {

using bench::RayKind;

struct BenchOptions {
    CommonOptions common;
    bench::RunOptions run;
    std::string scene;
    std::vector<RayKind> kinds;
    std::vector<double> growth = {1e3, 1e4, 1e5, 1e6, 1e7};
    std::size_t moves = 0;
    bool no_embree = false, no_build = false, is_feature_costs = false, is_trees = false, is_growth = false;
};

Section backends_section(BenchOptions& options) {
    bench::LineUpOptions& line_up = options.run.line_up;
    return {
        "Backends",
        {{.name = "--backends",
          .value = words(line_up.only, "PART,..."),
          .help = "those with one of these parts in their names, as sw,embree8; all if not given",
          .former_name = "--contestants"},
         {.name = "--levels", .value = choices(line_up.levels, names_of(all_levels)), .help = "of the triangle test"},
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
          .help = "time traces alone; --feature-costs, without memory"}}};
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

bench::RunOptions run_options_of(const BenchOptions& options) {
    bench::RunOptions run = options.run;
    run.seed = options.common.seed;
    run.quiet = options.common.quiet;
    run.times_builds = !options.no_build;
    run.line_up.has_embree = !options.no_embree;
    if (!options.kinds.empty())
        run.kinds = options.kinds;
    else if (options.is_growth)
        run.kinds = {RayKind::primary, RayKind::incoherent};
    return run;
}

void run(const BenchOptions& options) {
    const bench::Session session{
        .device = context_desc(options.common),
        .version = twinray_version,
        .run = run_options_of(options),
        .out = std::cout,
        .record = [&](const nlohmann::json& record) { append_json(options.common.json, record); }};
    if (options.moves) return bench_moves(session, options.moves);
    if (options.is_growth) return bench_growth(session, options.growth);
    const bench::BenchScene scene = bench::make_scene(options.scene);
    heed_warnings(scene.scene, options.scene, options.common);
    if (options.is_feature_costs) return bench_feature_costs(session, scene);
    if (options.is_trees) return bench_trees(session, scene);
    bench_scene(session, scene);
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
         {.name = "--feature-costs",
          .value = flag(options->is_feature_costs),
          .help = "what each feature costs that the scene does not need, on the first layout and level, and what an "
                  "accelerator keeps in memory",
          .needs = {"--scene"},
          .former_name = "--ladder"},
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
            .sections = {what, rays_section(*options), backends_section(*options), common_options(options->common)},
            .alternatives = {{.names = {"--scene", "--moves", "--growth"}, .is_required = true}},
            .examples = {{"twinray bench --scene sphere:100000 --levels watertight,certified",
                          "what certainty costs on a sphere of a hundred thousand triangles"}},
            .run = [options] {
                run(*options);
                return 0;
            }};
}

}  // namespace twinray::cli
