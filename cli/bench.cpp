// `twinray bench`: build times and trace rates of both accelerators beside others, with their errors.
#include "bench/command.h"
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
    bool is_feature_costs = false, is_trees = false, is_growth = false;
};

Section backends_section(BenchOptions& options) {
    bench::LineUpOptions& line_up = options.run.line_up;
    return {"Backends",
            {{.name = "--backends",
              .value = words(line_up.only, "PART,..."),
              .help = "only backends whose name contains one of these parts, such as sw,embree8; without it, all",
              .former_name = "--contestants"},
             {.name = "--levels",
              .value = choices(line_up.levels, names_of(all_levels)),
              .help = "levels of precision of the triangle test"},
             {.name = "--layouts",
              .value = choices(line_up.layouts, names_of(all_layouts)),
              .help = "memory layouts of the software accelerator's trees"},
             {.name = "--build-qualities",
              .value = choices(line_up.build_qualities, names_of(all_build_qualities)),
              .help = "build qualities of the software accelerator's trees"},
             {.name = "--ray-orders",
              .value = choices(line_up.ray_orders, names_of(all_ray_orders)),
              .help = "orders in which accelerators trace the rays"},
             {.name = "--no-embree",
              .value = flag([&options] { options.run.line_up.has_embree = false; }),
              .help = "do not measure Embree"},
             {.name = "--no-build",
              .value = flag([&options] { options.run.times_builds = false; }),
              .help = "measure only traces; with --feature-costs, do not measure memory"}}};
}

Section rays_section(BenchOptions& options) {
    bench::RunOptions& run = options.run;
    return {"Rays and rounds",
            {{.name = "--ray-kinds",
              .value = choices(options.kinds, names_of(bench::all_ray_kinds)),
              .help = "kinds of rays; without it, the first three, or the first two with --growth",
              .former_name = "--rays"},
             {.name = "--width",
              .value = number(run.width, {.least = 8, .most = 4096, .step = 8}),
              .help = "side length in pixels of the square image that primary rays sample, a multiple of 8"},
             {.name = "--rounds",
              .value = number(run.rounds, {1, 1000}),
              .help = "number of rounds; results are medians over rounds"},
             {.name = "--max-seconds",
              .value = number(run.max_seconds, {.least = 0, .is_above = true}),
              .help = "longest time of one trace; slower backends trace an even sample of the rays"}}};
}

bench::RunOptions run_options_of(const BenchOptions& options) {
    bench::RunOptions run = options.run;
    run.seed = options.common.seed;
    run.quiet = options.common.quiet;
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
        "Measurement",
        {{.name = "--scene",
          .value = word(options->scene, "SCENE"),
          .help = "scene file (.gltf, .glb, .obj, .ply, .stl), or a generated scene: sphere:N, soup:N or "
                  "instances:KxN, with N triangles and K instances"},
         {.name = "--moves",
          .value = number(options->moves, {1, 1 << 22}),
          .help = "compare refit with rebuild for N moving instances"},
         {.name = "--growth",
          .value = optional_list(options->is_growth, options->growth, {20, 5e7}),
          .help = "measure spheres with these numbers of triangles, one after the other"},
         {.name = "--feature-costs",
          .value = flag(options->is_feature_costs),
          .help = "measure the cost of each feature that the scene does not need, for the first layout and level, and "
                  "the memory that an accelerator keeps",
          .needs = {"--scene"},
          .former_name = "--ladder"},
         {.name = "--trees",
          .value = flag(options->is_trees),
          .help = "print memory, surface area cost, end-point overlap and steps per ray of the software accelerator's "
                  "trees, for each layout and build quality; these are counts, not times",
          .needs = {"--scene"}}}};
    return {.name = "bench",
            .group = "Checking",
            .summary = "measure build times and trace rates of both accelerators, and their errors",
            .description =
                "Builds and traces a scene with both accelerators, and with Embree if it is built in. The backends "
                "take turns in rounds. Prints medians, ratios within a round, memory, and how often hits differ from "
                "exact ones.",
            .sections = {what, rays_section(*options), backends_section(*options), common_options(options->common)},
            .alternatives = {{.names = {"--scene", "--moves", "--growth"}, .is_required = true}},
            .examples = {{"twinray bench --scene sphere:100000 --levels watertight,certified",
                          "cost of certified hits on a sphere of a hundred thousand triangles"}},
            .run = done_after([options] { run(*options); })};
}

}  // namespace twinray::cli
