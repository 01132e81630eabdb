// SPDX-License-Identifier: MIT
// `twinray verify`: hardware against software against the referees, float64 and exact.
#include <algorithm>
#include <iostream>

#include "cli/exact/referee.h"
#include "cli/ray_file.h"
#include "cli/replay/replay.h"
#include "cli/replay/scene_file.h"
#include "cli/replay/show.h"
#include "cli/verify/output.h"
#include "engine/accel/scene_push.h"
#include "engine/core/error.h"
#include "engine/core/progress.h"
#include "engine/verify/aimed_rays.h"
#include "swtlas/sw_tlas.h"
#include "twinray_version.h"

namespace twinray::cli {
namespace {

constexpr std::size_t batch_size = 1 << 18;
std::vector<RaySet> ray_sets(const VerifyOptions& options, const Oracle& oracle, const Scene& scene) {
    if (!options.rays.empty()) return {{"file", read_rays(options.rays, scene.origin)}};
    if (options.random + options.aimed == 0) fail("verify: --random 0 and --aimed 0 leave nothing to judge");
    const std::uint64_t seed = options.common.seed;
    return {{"random", random_rays(bounds_of(scene), options.random, seed)},
            {"vertex", vertex_aimed_rays(oracle, options.aimed, seed)},
            {"edge", edge_aimed_rays(oracle, options.aimed, seed)}};
}

// Built, and its kernel compiled, so that what is timed is tracing.
void build(AbstractAccel& accel, const Scene& scene) {
    push_scene(accel, scene);
    const Ray ray{vec3(0), 0, vec3(1), 1};
    static_cast<void>(accel.closest_hits(std::span(&ray, 1)));
}

const char* backend_of(const Fault& fault, const Context& context) {
    return fault.is_of_software ? "sw" : context.facts().ray_query ? "hw" : "hw-pipeline";
}

// Into the folder that was asked for; without one only faults of ours are written, to a folder of that name here.
std::filesystem::path replay_folder(const VerifyOptions& options, const Outcome& outcome) {
    if (!options.replays.empty()) return options.replays;
    return outcome.software.faults_of_ours() ? "twinray_replays" : "";
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
                      {std::filesystem::absolute(options.scene), hash, backend_of(fault, context), "watertight", kind,
                       fault.ray, fault.answer, reference_of(oracle, fault.ray, arbiter), context.facts().name,
                       context.facts().driver, twinray_version});
        ++written;
    }
    std::cout << "    " << written << " replays in " << folder.string() << "; show one: twinray verify --replay FILE\n";
}

// Returns the faults of ours.
std::uint64_t run(const VerifyOptions& options) {
    const Scene scene = load_scene_with_warnings(options.scene, options.common.quiet);
    const std::unique_ptr<Context> context = make_context(options.common);
    SwTlas sw(*context);
    const std::unique_ptr<HwTlas> hw =
        missing_for_hardware(context->facts()).empty() ? std::make_unique<HwTlas>(*context) : nullptr;
    build(sw, scene);
    if (hw) build(*hw, scene);
    const Oracle oracle = Oracle::of(scene);
    const exact::Referee referee(oracle);
    const Arbiter arbiter = [&](const Ray& ray) { return exact::to_float64(referee.closest_hit(ray), oracle); };

    std::cout << "verify " << options.scene.filename().string() << ": " << count_triangles(scene) << " triangles in "
              << scene.instances.size() << " instances, on " << context->facts().name << "; HwTlas by "
              << (hw ? hw->trace_path() : "nothing (unsupported on this device)") << '\n';
    std::uint64_t faults = 0;
    for (const RaySet& set : ray_sets(options, oracle, scene)) {
        Outcome outcome;
        Progress progress("verify " + set.name, set.rays.size(), options.common.quiet);
        for (std::size_t first = 0; first < set.rays.size(); first += batch_size) {
            const auto batch = std::span(set.rays).subspan(first, std::min(batch_size, set.rays.size() - first));
            judge(oracle, arbiter, batch, sw, hw.get(), outcome);
            progress.advance(batch.size());
        }
        print(set, outcome, hw != nullptr);
        append_records(options, {*context, scene, set, outcome, hw.get()});
        write_replays(options, scene, oracle, arbiter, *context, set, outcome);
        faults += outcome.software.faults_of_ours();
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

void add_verify(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("verify", "compare HwTlas, SwTlas and the referees; exit 1 on a fault of ours");
    const auto options = std::make_shared<VerifyOptions>();
    CLI::Option* scene = command->add_option("scene", options->scene, ".gltf, .glb, .obj, .ply or .stl");
    CLI::Option* replay =
        command->add_option("--replay", options->replay, "show a faulty ray of an earlier run step by step")
            ->check(CLI::ExistingFile)
            ->excludes(scene);
    command
        ->add_option("--replays", options->replays,
                     text("folder for faulty rays: ours, and up to ", max_faults_of_driver,
                          " of each class of the driver's; without it only ours are written, to twinray_replays"))
        ->excludes(replay);
    CLI::Option* rays = command->add_option("--rays", options->rays,
                                            "raw 32-byte rays, little endian, or .npy: N x 8 numbers, float64 too");
    command->add_option("--random", options->random, "random rays")->capture_default_str()->excludes(rays);
    command->add_option("--aimed", options->aimed, "rays aimed at vertices, and as many aimed at edges")
        ->capture_default_str()
        ->excludes(rays);
    add_common_options(*command, options->common);
    command->callback([options, &exit_code] {
        if (options->scene.empty() && options->replay.empty())
            throw CLI::RequiredError("verify: a scene, or --replay FILE,");
        exit_code = (options->replay.empty() ? run(*options) > 0 : run_replay(*options)) ? 1 : 0;
    });
}

}  // namespace twinray::cli
