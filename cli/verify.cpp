// `twinray verify`: hardware against software against the references, float64 and exact.
#include "cli/common.h"
#include "engine/scene/ray_file.h"
#include "twinray_version.h"
#include "validation/exact/exact_reference.h"
#include "report/explain/explain.h"
#include "report/reproducer/reproduce.h"
#include "validation/verify/comparison.h"
#include "samples/support/progress.h"
#include "validation/reference/aimed_rays.h"
#include "report/replay/replay.h"
#ifdef TWINRAY_HAS_REPORT
#include "cli/verify_conformance.h"
#endif

namespace twinray::cli {
namespace {

struct VerifyOptions {
    CommonOptions common;
    std::filesystem::path scene, rays;
    std::filesystem::path replay;                   // in place of a scene
    std::filesystem::path replays;                  // folder; "" = only faults of twinray are written
    std::filesystem::path reproducers, reproducer;  // folders of faults of the driver
#ifdef TWINRAY_HAS_REPORT
    SuiteOptions suite;  // in place of a scene
#endif
    std::size_t random = 100'000;
    std::size_t aimed = 10'000;
    Level level = Level::watertight;
};

std::vector<RaySet> ray_sets(const VerifyOptions& options, const ReferenceScene& reference, const Scene& scene) {
    if (!options.rays.empty()) return {{"file", read_rays(options.rays, scene.origin)}};
    return test_rays(reference, bounds_of(scene), options.random, options.aimed, options.common.seed);
}

// Returns 0 at level fast, which promises nothing.
std::uint64_t faults_of_ours(const VerifyOptions& options, const Comparison& comparison) {
    return options.level == Level::fast ? 0 : comparison.software.faults_of_ours();
}

std::string result_text(const VerifyOptions& options, std::uint64_t faults) {
    if (options.level == Level::fast)
        return "no fault of twinray: level fast may lose rays at edges and hit twice there";
    return faults ? text(faults, " faults of twinray") : "no fault of twinray";
}

// Returns the requested folder. Without one, only faults of twinray are written, to twinray_replays here; "" if there
// are none.
std::filesystem::path replay_folder(const VerifyOptions& options, const Comparison& comparison) {
    if (!options.replays.empty()) return options.replays;
    return faults_of_ours(options, comparison) ? "twinray_replays" : "";
}

// Returns the fields that all replays of a run share.
replay::Replay replay_of(const VerifyOptions& options, const Scene& scene, const DeviceProperties& device) {
    return {.scene = std::filesystem::absolute(options.scene),
            .scene_hash = replay::hash_of(scene),
            .backend = device.ray_query ? "hw" : "hw-pipeline",
            .level = std::string(name_of(options.level)),
            .kind = {},
            .reference = {},
            .device = device.name,
            .driver = device.driver,
            .twinray = twinray_version};
}

// Keeps the driver's first fault of each class.
void keep_first(std::vector<Fault>& firsts, const std::vector<Fault>& faults) {
    for (const Fault& fault : faults)
        if (!fault.is_of_software && std::ranges::count(firsts, fault.kind, &Fault::kind) == 0) firsts.push_back(fault);
}

// Writes a folder for each fault.
void write_reproducers(const VerifyOptions& options, const Scene& scene, const replay::Replay& common,
                       const std::vector<Fault>& faults) {
    if (faults.empty()) std::cout << "  no fault of the driver, so no reproducer\n";
    frame::Devices devices(context_desc(options.common));
    for (const Fault& fault : faults) {
        replay::Replay replay = common;
        replay.kind = name_of(fault.kind);
        replay.ray = fault.ray;
        const std::filesystem::path folder = options.reproducers / replay.kind;
        try {
            std::cout << "  " << reproducer::write_reproducer(folder, scene, replay, devices) << '\n';
        } catch (const Error& error) {
            std::cout << "  no reproducer of " << replay.kind << ": " << error.what() << '\n';
        }
    }
}

// Returns the number of twinray's faults.
std::uint64_t run(const VerifyOptions& options) {
    const Scene scene = load_scene(options.scene, options.common);
    const std::unique_ptr<Context> context = make_context(options.common);
    Verifier verifier(
        *context, ReferenceScene::of(scene), [&](AbstractAccel& accel) { push_scene(accel, scene); }, options.level);
    const ReferenceScene& reference = verifier.reference();
    const exact::Reference exact_reference(reference);
    const Arbiter arbiter = [&](const Ray& ray) { return exact_reference.rounded_hit(ray); };
    const HwTlas* const hardware = verifier.hardware();
    std::cout << "verify " << options.scene.filename().string() << ": " << count_triangles(scene) << " triangles in "
              << scene.instances.size() << " instances, at " << name_of(options.level) << " on "
              << context->properties().name
              << (hardware ? text("; HwTlas by ", hardware->trace_path())
                           : text("; without HwTlas (", verifier.why_no_hardware(), ')'))
              << '\n';
    nlohmann::json base = base_record("twinray-report/1", *context, options.scene, scene);
    base.update({{"level", name_of(options.level)}, {"seed", options.common.seed}});
    std::uint64_t faults = 0;
    std::vector<Fault> of_driver;
    for (const RaySet& set : ray_sets(options, reference, scene)) {
        samples::Progress progress("verify " + set.name, set.rays.size(), options.common.quiet);
        const Comparison comparison =
            verifier.compare(set.rays, arbiter, [&](std::size_t rays) { progress.advance(rays); });
        print(std::cout, set, comparison, hardware != nullptr);
        for (const nlohmann::json& record : records_of(base, set, comparison, hardware))
            append_json(options.common.json, record);
        const std::filesystem::path folder = replay_folder(options, comparison);
        if (!folder.empty() && !comparison.faults.empty())
            std::cout << "    "
                      << replay::write_faults(folder, set.name, comparison.faults, !options.replays.empty(),
                                              replay_of(options, scene, context->properties()),
                                              [&](const Ray& ray) { return reference_hit(reference, ray, arbiter); })
                      << " replays in " << folder.string() << "; show one: twinray verify --replay FILE\n";
        faults += faults_of_ours(options, comparison);
        keep_first(of_driver, comparison.faults);
    }
    if (!options.reproducers.empty())
        write_reproducers(options, scene, replay_of(options, scene, context->properties()), of_driver);
    std::cout << result_text(options, faults) << '\n';
    return faults;
}

bool run_replay(const VerifyOptions& options) {
    frame::Devices devices(context_desc(options.common));
    const bool is_fault = replay::show(options.replay, devices, std::cout);
    std::cout << (is_fault ? "a fault of twinray" : "no fault of twinray") << '\n';
    if (!options.reproducer.empty())
        std::cout << reproducer::write_reproducer(options.reproducer, options.replay, devices) << '\n';
    return is_fault;
}

}  // namespace

Command verify_command() {
    const auto options = std::make_shared<VerifyOptions>();
    Option scene = scene_argument(options->scene);
    scene.is_required = false;
    const Section rays = {
        "Rays",
        {{.name = "--rays",
          .value = file(options->rays),
          .help = "compare these rays, in the format of `twinray trace`"},
         {.name = "--random",
          .value = number(options->random),
          .help = "number of random rays",
          .excludes = {"--rays"}},
         {.name = "--aimed",
          .value = number(options->aimed),
          .help = "number of rays aimed at vertices, and of rays aimed at edges",
          .excludes = {"--rays"}},
         level_option(options->level, "precision of the triangle test; faults count at every level but fast")}};
    const Section replays = {
        "Faulty rays",
        {{.name = "--replays",
          .value = folder(options->replays),
          .help =
              text("write a replay file to this folder for each fault of twinray, and for up to ", max_faults_of_driver,
                   " faults of each class of the driver; without it, faults of twinray only, to twinray_replays")},
         {.name = "--replay",
          .value = file(options->replay),
          .help = "explain the faulty ray of this replay file step by step, instead of reading a scene",
          .excludes = {"--replays", "--reproducers"}},
         {.name = "--reproducers",
          .value = folder(options->reproducers),
          .help = "write a folder for the first fault of each class of the driver, with a C program that shows it, a "
                  "scene of few triangles and a text for the driver's issue tracker"},
         {.name = "--reproducer",
          .value = folder(options->reproducer),
          .help = "write such a folder for the ray of --replay",
          .needs = {"--replay"}}}};
    Command command{
        .name = "verify",
        .group = "Checking",
        .summary = "compare both accelerators with exact answers, ray by ray",
        .description =
            "Traces random rays, and rays aimed at vertices and edges, with both accelerators. Checks each hit against "
            "a reference in float64 and, if float64 cannot decide, in rational arithmetic. Prints how many hits agree, "
            "are ties, leaks, false or imprecise, and an upper bound of the rate of faults (95 %).",
        .positionals = {scene},
        .sections = {rays, replays, common_options(options->common)},
        .examples = {{"twinray verify scene.gltf --random 1000000", "trace a million random rays in a scene"}},
        .fault = "the software accelerator has a fault",
        .run = [options] {
            if (options->scene.empty() == options->replay.empty())
                throw UsageError("one of SCENE and --replay FILE is required");
            if (options->random + options->aimed == 0)
                throw UsageError("--random 0 and --aimed 0 leave nothing to compare");
            return (options->replay.empty() ? run(*options) > 0 : run_replay(*options)) ? 1 : 0;
        }};
#ifdef TWINRAY_HAS_REPORT
    command.sections.insert(command.sections.end() - 1, suite_section(options->suite));
    command.examples.push_back({"twinray verify --suite conformance", "test the driver's own acceleration structures"});
    command.run = [options, run = command.run] {
        if (!options->scene.empty() + !options->replay.empty() + !options->suite.name.empty() != 1)
            throw UsageError("one of SCENE, --replay FILE and --suite conformance is required");
        return options->suite.name.empty() ? run() : verify_suite(options->common, options->suite);
    };
#endif
    return command;
}

}  // namespace twinray::cli
