// SPDX-License-Identifier: MIT
// `twinray bench`: build times and trace rates of both accelerators on the same rays, interleaved in one process.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>

#include "cli/common.h"
#include "engine/accel/scene_push.h"
#include "engine/core/error.h"
#include "engine/report/statistics.h"
#include "engine/verify/aimed_rays.h"
#include "engine/verify/classify.h"
#include "hwtlas/hw_tlas.h"
#include "swtlas/sw_tlas.h"

namespace twinray::cli {
namespace {

struct BenchOptions {
    CommonOptions common;
    std::filesystem::path scene;
    uint width = 1024;
    std::size_t rounds = 5;
    std::size_t moves = 0;
    std::vector<Level> levels = {Level::watertight};
    std::vector<Layout> layouts = {all_layouts.begin(), all_layouts.end()};
};

// By Level.
constexpr const char* level_names[] = {"fast", "watertight", "refined", "certified"};
const char* name_of(Level level) { return level_names[static_cast<std::size_t>(level)]; }

struct Candidate {
    std::string name, backend, path;
    std::string layout;
    Level level;
    std::function<std::unique_ptr<AbstractAccel>()> make;
    std::unique_ptr<AbstractAccel> accel = {};
    std::vector<double> build_ms = {}, trace_ms = {};
    std::vector<Hit> hits = {};
};

double total_ms(const std::vector<PassTiming>& timings) {
    double sum = 0;
    for (const PassTiming& timing : timings) sum += timing.ms;
    return sum;
}

// The first is what all are compared with.
std::vector<Candidate> make_candidates(Context& context, std::span<const Level> levels,
                                       std::span<const Layout> layouts) {
    std::vector<Candidate> candidates;
    for (const Layout layout : layouts)
        for (const Level level : levels)
            candidates.push_back({text("sw ", name_of(layout), ' ', name_of(level)), "sw", "compute",
                                  std::string(name_of(layout)), level, [&, level, layout] {
                                      return std::make_unique<SwTlas>(context, AccelOptions{level, layout});
                                  }});
    if (!missing_for_hardware(context.facts()).empty()) return candidates;
    const auto add = [&](const std::string& name, BuildOrder order, Level level) {
        candidates.push_back(
            {name, "hw", HwTlas(context, order).trace_path(), "driver", level,
             [&context, order, level] { return std::make_unique<HwTlas>(context, order, AccelOptions{level}); }});
    };
    for (const Level level : levels)
        if (HwTlas::capability_on(context.facts(), feature_of(level)).support != Support::unsupported)
            add(text("hw ", name_of(level)), BuildOrder::automatic, level);
    if (context.facts().builds_in_input_order) add("hw input order", BuildOrder::input, levels.front());
    return candidates;
}

// A build from nothing; the last one is kept.
double build_once(Candidate& candidate, const Scene& scene) {
    candidate.accel = candidate.make();
    push_scene(*candidate.accel, scene);
    candidate.accel->sync();
    return total_ms(candidate.accel->build_timings());
}

double trace_once(const Candidate& candidate, const Buffer& rays, const Buffer& hits, std::uint64_t count) {
    Commands commands(candidate.accel->context(), "bench");
    candidate.accel->trace(
        commands, candidate.accel->view(),
        {.rays = rays.ref<Ray>(), .hits = hits.ref<Hit>(), .count = count, .level = candidate.level});
    commands.submit();
    return total_ms(commands.timings());
}

// Errors of a sample of the hits, judged by the referee.
Classes judge(const Oracle& oracle, const Candidate& candidate, const std::vector<Ray>& rays) {
    constexpr std::size_t sample = 20'000;
    std::vector<Ray> some_rays;
    std::vector<Hit> some_hits;
    for (std::size_t i = 0; i < rays.size(); i += std::max<std::size_t>(rays.size() / sample, 1)) {
        some_rays.push_back(rays[i]);
        some_hits.push_back(candidate.hits[i]);
    }
    Classes classes;
    const bool ours = candidate.backend == "sw";
    const std::vector<Verdict> verdicts =
        ours ? classify_all(oracle, some_rays, some_hits, {}) : classify_all(oracle, some_rays, {}, some_hits);
    for (const Verdict& verdict : verdicts) classes.add(ours ? *verdict.software : *verdict.hardware);
    return classes;
}

void report(const BenchOptions& options, const Context& context, const std::vector<Candidate>& candidates,
            const Scene& scene, const std::vector<Ray>& rays) {
    const Oracle oracle = Oracle::of(scene);
    const double triangles = static_cast<double>(std::max<std::size_t>(count_triangles(scene), 1));
    std::cout << "  accelerator                 build ms  Mrays/s   sw is faster by  bytes/triangle  agree or tie with "
                 "float64\n";
    for (const Candidate& candidate : candidates) {
        const double build_ms = median(candidate.build_ms);
        const double mrays = static_cast<double>(rays.size()) / median(candidate.trace_ms) * 1e-3;
        const Classes classes = judge(oracle, candidate, rays);
        const double sound =
            static_cast<double>(classes[Class::agree] + classes[Class::tie]) / static_cast<double>(classes.total());
        const double ratio = median(candidate.trace_ms) / median(candidates.front().trace_ms);
        const double bytes = static_cast<double>(candidate.accel->memory_usage().structures()) / triangles;
        std::cout << "  " << std::left << std::setw(25) << candidate.name << std::right << std::fixed
                  << std::setprecision(1) << std::setw(11) << build_ms << std::setprecision(3) << std::setw(9) << mrays
                  << std::setprecision(2) << std::setw(15) << ratio << 'x' << std::setprecision(1) << std::setw(16)
                  << bytes << std::setprecision(4) << std::setw(17) << 100 * sound << " % of " << classes.total()
                  << '\n';
        append_json(options.common.json, {{"schema", "twinray-bench/1"},
                                          {"device", describe(context)},
                                          {"scene", options.scene.string()},
                                          {"rays", "primary"},
                                          {"n", rays.size()},
                                          {"rounds", options.rounds},
                                          {"backend", candidate.backend},
                                          {"path", candidate.path},
                                          {"order", candidate.name == "hw input order" ? "input" : "sorted"},
                                          {"layout", candidate.layout},
                                          {"builder", candidate.backend == "sw" ? "lbvh" : "driver"},
                                          {"level", name_of(candidate.level)},
                                          {"mrays_per_s", mrays},
                                          {"build_ms", build_ms},
                                          {"bytes_per_triangle", bytes},
                                          {"vs_sw", 1 / ratio},
                                          {"agreement", sound}});
    }
}

void run(const BenchOptions& options) {
    const Scene scene = load_scene_with_warnings(options.scene, options.common.quiet);
    const std::unique_ptr<Context> context = make_context(options.common);
    const std::vector<Ray> rays = primary_rays(bounds_of(scene), options.width);
    std::vector<Candidate> candidates = make_candidates(*context, options.levels, options.layouts);
    const Buffer ray_buffer(*context, {.name = "bench rays", .bytes = rays.size() * sizeof(Ray)});
    const Buffer hit_buffer(*context, {.name = "bench hits", .bytes = rays.size() * sizeof(Hit)});
    Commands upload(*context, "bench input");
    {
        const auto pass = upload.pass("bench rays");
        upload.upload(ray_buffer, std::span<const Ray>(rays));
    }
    upload.submit();

    std::cout << "bench " << options.scene.filename().string() << ": " << count_triangles(scene) << " triangles, "
              << rays.size() << " primary rays, median of " << options.rounds << " interleaved rounds, on "
              << context->facts().name << '\n';
    for (Candidate& candidate : candidates) {  // warm up: drivers compile at the first dispatch
        build_once(candidate, scene);
        trace_once(candidate, ray_buffer, hit_buffer, rays.size());
        candidate.hits = download<Hit>(*context, hit_buffer, rays.size());
    }
    for (std::size_t round = 0; round < options.rounds; ++round)
        for (Candidate& candidate : candidates) {
            candidate.build_ms.push_back(build_once(candidate, scene));
            candidate.trace_ms.push_back(trace_once(candidate, ray_buffer, hit_buffer, rays.size()));
        }
    report(options, *context, candidates, scene, rays);
}

}  // namespace

void add_bench(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand("bench", "build and trace rates of both accelerators, with their errors");
    const auto options = std::make_shared<BenchOptions>();
    auto* what = command->add_option_group("what")->require_option(1);
    what->add_option("--scene", options->scene, ".gltf, .glb, .obj, .ply or .stl");
    what->add_option("--moves", options->moves, "refit of so many instances that move, against a rebuild")
        ->check(CLI::Range(1, 1 << 22));
    command->add_option("--width", options->width, "pixels a side of the square of primary rays, a multiple of 8")
        ->check(CLI::Range(8, 4096))
        ->check([](const std::string& width) {
            return std::stoul(width) % 8 == 0 ? std::string() : width + " is not a multiple of 8";
        })
        ->capture_default_str();
    const std::map<std::string, Level> levels = {{"fast", Level::fast},
                                                 {"watertight", Level::watertight},
                                                 {"refined", Level::refined},
                                                 {"certified", Level::certified}};
    command->add_option("--levels", options->levels, "fast, watertight, refined, certified; separated by commas")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(levels));
    command->add_option("--layouts", options->layouts, "of SwTlas: compressed4, bvh2; separated by commas")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(layouts_by_name()));
    command->add_option("--rounds", options->rounds)->check(CLI::Range(1, 1000))->capture_default_str();
    add_common_options(*command, options->common);
    command->callback([options] {
        if (options->moves)
            bench_moves(options->common, options->moves, options->rounds);
        else
            run(*options);
    });
}

}  // namespace twinray::cli
