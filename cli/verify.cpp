// SPDX-License-Identifier: MIT
// `twinray verify`: hardware against software against the referees, float64 and exact.
#include <algorithm>
#include <iostream>

#include <twinray/scene.h>

#include "cli/command/values.h"
#include "cli/commands.h"
#include "validation/exact/referee.h"
#include "cli/ray_file.h"
#include "validation/replay/replay.h"
#include "validation/replay/scene_file.h"
#include "validation/replay/show.h"
#include "cli/verify/output.h"
#include "engine/core/error.h"
#include "engine/core/progress.h"
#include "engine/verify/aimed_rays.h"
#include <twinray/tlas.h>
#include "twinray_version.h"

namespace twinray::cli {
namespace {

std::vector<RaySet> ray_sets(const VerifyOptions& options, const Oracle& oracle, const Scene& scene) {
    if (!options.rays.empty()) return {{"file", read_rays(options.rays, scene.origin)}};
    if (options.random + options.aimed == 0) throw UsageError("--random 0 and --aimed 0 leave nothing to judge");
    const std::uint64_t seed = options.common.seed;
    return {{"random", random_rays(bounds_of(scene), options.random, seed)},
            {"vertex", vertex_aimed_rays(oracle, options.aimed, seed)},
            {"edge", edge_aimed_rays(oracle, options.aimed, seed)}};
}

// Built, and its kernel compiled, so that what is timed is tracing.
void build(AbstractAccel& accel, const Scene& scene, Level level) {
    push_scene(accel, scene);
    const Ray ray{vec3(0), 0, vec3(1), 1};
    static_cast<void>(accel.closest_hits(std::span(&ray, 1), {.level = level}));
}

// "" if it can.
std::string why_no_hardware(const DeviceFacts& device, Level level) {
    if (const std::vector<std::string> missing = missing_for_hardware(device); !missing.empty())
        return "the device lacks " + twinray::joined(missing);
    const Capability able = HwTlas::capability_on(device, feature_of(level));
    return able.support == Support::unsupported ? text(name_of(able.feature), ": ", able.note) : "";
}

// Level fast promises nothing.
std::uint64_t faults_of_ours(const VerifyOptions& options, const Outcome& outcome) {
    return options.level == Level::fast ? 0 : outcome.software.faults_of_ours();
}

const char* backend_of(const Fault& fault, const Context& context) {
    return fault.is_of_software ? "sw" : context.facts().ray_query ? "hw" : "hw-pipeline";
}

// Into the folder that was asked for; without one only faults of ours are written, to a folder of that name here.
std::filesystem::path replay_folder(const VerifyOptions& options, const Outcome& outcome) {
    if (!options.replays.empty()) return options.replays;
    return faults_of_ours(options, outcome) ? "twinray_replays" : "";
}

void write_replays(const VerifyOptions& options, const Scene& scene, const Oracle& oracle, const Arbiter& arbiter,
                   const Context& context, const RaySet& set, const Outcome& outcome) {
    const std::filesystem::path folder = replay_folder(options, outcome);
    if (folder.empty() || outcome.faults.empty()) return;
    std::filesystem::create_directories(folder);
    const std::string hash = replay::hash_of(scene);
    std::map<Class, std::size_t> numbers;
    std::size_t written = 0;
    for (const Fault& fault : outcome.faults) {
        if (options.replays.empty() && !fault.is_of_software) continue;
        const std::string kind(name(fault.kind));
        replay::write(folder / text(set.name, '-', kind, '-', ++numbers[fault.kind], ".json"),
                      {std::filesystem::absolute(options.scene), hash, backend_of(fault, context),
                       name_of(options.level), kind, fault.ray, fault.answer, reference_of(oracle, fault.ray, arbiter),
                       context.facts().name, context.facts().driver, twinray_version});
        ++written;
    }
    std::cout << "    " << written << " replays in " << folder.string() << "; show one: twinray verify --replay FILE\n";
}

// Returns the faults of ours.
std::uint64_t run(const VerifyOptions& options) {
    const Scene scene = load_scene(options.scene, options.common);
    const std::unique_ptr<Context> context = make_context(options.common);
    const AccelOptions accel{.level = std::max(options.level, Level::watertight)};
    SwTlas sw(*context, accel);
    const std::string why_not = why_no_hardware(context->facts(), options.level);
    const std::unique_ptr<HwTlas> hw =
        why_not.empty() ? std::make_unique<HwTlas>(*context, BuildOrder::automatic, accel) : nullptr;
    build(sw, scene, options.level);
    if (hw) build(*hw, scene, options.level);
    const Oracle oracle = Oracle::of(scene);
    const exact::Referee referee(oracle);
    const Arbiter arbiter = [&](const Ray& ray) { return exact::to_float64(referee.closest_hit(ray), oracle); };

    std::cout << "verify " << options.scene.filename().string() << ": " << count_triangles(scene) << " triangles in "
              << scene.instances.size() << " instances, at " << name_of(options.level) << " on "
              << context->facts().name
              << (hw ? text("; HwTlas by ", hw->trace_path()) : text("; without HwTlas (", why_not, ')')) << '\n';
    constexpr std::size_t batch_size = 1 << 18;
    std::uint64_t faults = 0;
    for (const RaySet& set : ray_sets(options, oracle, scene)) {
        Outcome outcome;
        Progress progress("verify " + set.name, set.rays.size(), options.common.quiet);
        for (std::size_t first = 0; first < set.rays.size(); first += batch_size) {
            const auto batch = std::span(set.rays).subspan(first, std::min(batch_size, set.rays.size() - first));
            judge(oracle, arbiter, batch, options.level, sw, hw.get(), outcome);
            progress.advance(batch.size());
        }
        print(set, outcome, hw != nullptr);
        append_records(options, {*context, scene, set, outcome, hw.get()});
        write_replays(options, scene, oracle, arbiter, *context, set, outcome);
        faults += faults_of_ours(options, outcome);
    }
    std::cout << (faults ? text(faults, " faults of ours") : std::string("no fault of ours")) << '\n';
    return faults;
}

bool run_replay(const VerifyOptions& options) {
    suite::Devices devices(context_desc(options.common));
    const bool is_fault = replay::show(options.replay, devices, std::cout);
    std::cout << (is_fault ? "a fault of ours" : "no fault of ours") << '\n';
    return is_fault;
}

}  // namespace

Command verify_command() {
    const auto options = std::make_shared<VerifyOptions>();
    Option scene = scene_argument(options->scene);
    scene.is_required = false;
    const Section rays = {
        "Rays",
        {{.name = "--rays", .value = file(options->rays), .help = "judge these: 32 bytes each, as of `twinray trace`"},
         {.name = "--random", .value = number(options->random), .help = "how many random rays", .excludes = {"--rays"}},
         {.name = "--aimed",
          .value = number(options->aimed),
          .help = "how many rays aimed at vertices, and as many at edges",
          .excludes = {"--rays"}},
         level_option(options->level, "of the triangle test, faults of which count but of fast")}};
    const Section replays = {
        "Faulty rays",
        {{.name = "--replays",
          .value = folder(options->replays),
          .help = text("written: a file for each fault of ours, and up to ", max_faults_of_driver,
                       " of each class of the driver's; if not given, only those of ours, to twinray_replays")},
         {.name = "--replay",
          .value = file(options->replay),
          .help = "instead of a scene: show a faulty ray of an earlier run step by step",
          .excludes = {"--replays"}}}};
    return {.name = "verify",
            .group = "Checking",
            .summary = "compare both accelerators with exact answers, ray by ray",
            .description =
                "Traces random rays, and rays aimed at vertices and edges, with the hardware and the "
                "software accelerator, and judges each hit by a reference in float64 and, where that cannot "
                "tell, in rational arithmetic. Says how many hits agree, are ties, leaks, false or "
                "imprecise, and below which rate faults are (95 %).",
            .positionals = {scene},
            .sections = {rays, replays, common_options(options->common)},
            .examples = {{"twinray verify scene.gltf --random 1000000", "a million random rays on a scene"}},
            .fault = "the software accelerator has a fault",
            .run = [options] {
                if (options->scene.empty() == options->replay.empty())
                    throw UsageError("either a SCENE or --replay FILE is required");
                return (options->replay.empty() ? run(*options) > 0 : run_replay(*options)) ? 1 : 0;
            }};
}

}  // namespace twinray::cli
