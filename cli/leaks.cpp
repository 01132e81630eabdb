// `twinray leaks`: as many rays as one likes from inside a closed mesh at its vertices and edges, and no way out.
#include <iomanip>

#include "cli/common.h"
#include "validation/leaks/leak_test.h"
#include "samples/support/progress.h"
#include "validation/leaks/closed_mesh.h"
#include <twinray/abstract_accel.h>

namespace twinray::cli {
namespace {

struct LeaksOptions {
    CommonOptions common;
    std::filesystem::path scene, state;
    std::uint64_t rays = 1'000'000;
    std::string accel = "auto";
    Level level = Level::watertight;
};

constexpr std::size_t max_printed_faults = 20;
constexpr double seconds_between_saves = 1;

nlohmann::json identity_of(const LeaksOptions& options, const AccelChoice& choice, const Mesh& mesh,
                           const Context& context) {
    return {{"schema", "twinray-leaks/1"},     {"mesh", text(std::hex, hash_of(mesh))},
            {"seed", options.common.seed},     {"backend", choice.name()},
            {"level", name_of(options.level)}, {"device", describe(context)["name"]}};
}

void print_fault(const LeakFault& fault) {
    const auto& [origin, t_min, direction, t_max] = fault.ray;
    std::cout << "  " << (fault.is_leak ? "leak" : "double hit") << ", crossed " << fault.crossings << " times: ray "
              << fault.ray_index << std::hexfloat << ", origin " << origin.x << ' ' << origin.y << ' ' << origin.z
              << " direction " << direction.x << ' ' << direction.y << ' ' << direction.z << std::defaultfloat
              << std::endl;
}

void trace_all(const LeaksOptions& options, const LeakTest& test, const nlohmann::json& identity, LeakState& state) {
    std::uint64_t printed = state.counts.faults();
    samples::Progress progress("leaks", options.rays, options.common.quiet);
    progress.advance(std::min(state.counts.rays, options.rays));
    double saved = state.seconds;
    const auto on_fault = [&](const LeakFault& fault) {
        if (printed++ < max_printed_faults) print_fault(fault);
    };
    trace_until(test, options.rays, state, on_fault, [&](std::size_t count) {
        progress.advance(count);
        const bool is_due = state.seconds - saved > seconds_between_saves || state.counts.rays == options.rays;
        if (options.state.empty() || !is_due) return;
        write_state(options.state, identity, state);
        saved = state.seconds;
    });
}

void print(const AccelChoice& choice, const LeakState& state) {
    const LeakCounts& counts = state.counts;
    const char* whose = choice.is_software ? "twinray" : "the driver";
    std::cout << "  " << counts.rays << " rays: " << counts.leaks << " leaks, " << counts.double_hits
              << " double hits by " << whose;
    if (counts.unspecified) std::cout << "; " << counts.unspecified << " are undecided: edge-on at the origin";
    std::cout << "\n  true rate below " << std::setprecision(2) << counts.bound_95() << " (95 %); "
              << std::setprecision(3) << static_cast<double>(counts.rays) * 1e-6 / state.seconds << " Mrays/s\n";
}

void append_record(const LeaksOptions& options, const Context& context, const AccelChoice& choice, const Scene& scene,
                   const LeakState& state) {
    const LeakCounts& counts = state.counts;
    nlohmann::json record = base_record("twinray-report/1", context, options.scene, scene);
    record.update(describe(choice));
    record.update({{"case", "leaks"},
                   {"level", name_of(options.level)},
                   {"reference", "analytic"},
                   {"n", counts.rays},
                   {"seed", options.common.seed},
                   {"counts",
                    {{"AGREE", counts.rays - counts.faults() - counts.unspecified},
                     {"LEAK", counts.leaks},
                     {"DOUBLE_HIT", counts.double_hits},
                     {"UNSPECIFIED", counts.unspecified}}},
                   {"faults", counts.faults()},
                   {"bound95", counts.bound_95()},
                   {"seconds", state.seconds},
                   {"pass", counts.faults() == 0},
                   {"criterion", "every ray crosses an odd number of triangles"}});
    append_json(options.common.json, record);
}

// Returns the number of twinray's faults.
std::uint64_t run(const LeaksOptions& options) {
    if (!options.state.empty()) check_writable(options.state);
    const std::string file = options.scene.filename().string();
    const Scene scene = load_scene(options.scene, options.common);
    const Mesh mesh = joined(scene, file);
    const std::unique_ptr<Context> context = make_context(options.common);
    const AccelChoice choice =
        choose_accel(context->properties(), options.accel, {.level = options.level, .kernel_queries = true});
    const nlohmann::json identity = identity_of(options, choice, mesh, *context);
    const bool goes_on = !options.state.empty() && std::filesystem::exists(options.state);
    LeakState state = goes_on ? read_state(options.state, identity) : LeakState();
    const std::unique_ptr<AbstractAccel> accel =
        twinray::make_accel(*context, choice, {.level = std::max(options.level, Level::watertight)});
    const LeakTest test(*accel, mesh, options.level, options.common.seed);
    std::cout << "leaks " << file << ": closed, " << mesh.triangles.size() << " triangles; " << text_of(choice)
              << " at " << name_of(options.level) << " on " << context->properties().name << '\n';
    if (goes_on) std::cout << "  continues after " << state.counts.rays << " rays\n";
    trace_all(options, test, identity, state);
    print(choice, state);
    append_record(options, *context, choice, scene, state);
    return choice.is_software ? state.counts.faults() : 0;
}

}  // namespace

Command leaks_command() {
    const auto options = std::make_shared<LeaksOptions>();
    Option scene = scene_argument(options->scene);
    scene.help += "; every edge must lie between two triangles";
    const Section rays = {"Rays",
                          {{.name = "--ray-count",
                            .value = number(options->rays, {.least = 1}),
                            .help = "total number of rays",
                            .former_name = "--rays"},
                           {.name = "--state",
                            .value = file(options->state),
                            .help = "save the state of the run to FILE, and continue from it if FILE exists",
                            .former_name = "--resume"},
                           accel_option(options->accel, "accelerator whose hits are counted"),
                           level_option(options->level)}};
    return {
        .name = "leaks",
        .group = "Checking",
        .summary = "test a closed mesh for leaks with rays from inside",
        .description =
            "Starts rays inside a closed mesh and aims them at its vertices and at points of its edges, where a test "
            "that is not watertight loses rays. A ray that crosses an even number of triangles has leaked or hit a "
            "triangle twice, so no reference is needed. Prints the first such rays exactly, as hexadecimal floats.",
        .positionals = {scene},
        .sections = {rays, common_options(options->common)},
        .examples = {{"twinray leaks torus.ply --ray-count 1e8 --state torus.json",
                      "a hundred million rays; interrupt and repeat the command to continue"}},
        .fault = "the software accelerator leaks a ray or hits a triangle twice",
        .run = [options] { return run(*options) > 0 ? 1 : 0; }};
}

}  // namespace twinray::cli
