// SPDX-License-Identifier: MIT
// `twinray verify`: hardware against software against the float64 referee.
#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <map>

#include "cli/common.h"
#include "engine/accel/scene_push.h"
#include "engine/core/error.h"
#include "engine/core/progress.h"
#include "engine/report/statistics.h"
#include "engine/verify/aimed_rays.h"
#include "engine/verify/classify.h"
#include "hwtlas/hw_tlas.h"
#include "swtlas/sw_tlas.h"

namespace twinray::cli {
namespace {

struct VerifyOptions {
    CommonOptions common;
    std::filesystem::path scene, rays;
    std::size_t random = 100'000;
    std::size_t aimed = 10'000;
};

struct RaySet {
    std::string name;
    std::vector<Ray> rays;
};

// What one set of rays gave.
struct Outcome {
    Classes software, hardware;
    std::map<std::pair<Class, Class>, std::uint64_t> disagreements;  // by (software, hardware), where answers differ
    std::vector<Ray> faulty;                                         // the first few
    double software_seconds = 0, hardware_seconds = 0;

    std::uint64_t disagreeing() const {
        std::uint64_t count = 0;
        for (const auto& [classes, n] : disagreements) count += n;
        return count;
    }
};

constexpr std::size_t batch_size = 1 << 18;
constexpr std::size_t max_printed_faults = 5;

std::vector<RaySet> ray_sets(const VerifyOptions& options, const Oracle& oracle, const Bounds& bounds) {
    if (!options.rays.empty()) return {{"file", read_rays(options.rays)}};
    if (options.random + options.aimed == 0) fail("verify: --random 0 and --aimed 0 leave nothing to judge");
    const std::uint64_t seed = options.common.seed;
    return {{"random", random_rays(bounds, options.random, seed)},
            {"vertex", vertex_aimed_rays(oracle, options.aimed, seed)},
            {"edge", edge_aimed_rays(oracle, options.aimed, seed)}};
}

bool is_same(const Hit& a, const Hit& b) {
    return a.hit == b.hit && a.instance_index == b.instance_index && a.primitive_index == b.primitive_index;
}

template <class Call>
auto timed(double& seconds, const Call& call) {
    const auto start = std::chrono::steady_clock::now();
    auto result = call();
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

void judge(const Oracle& oracle, std::span<const Ray> rays, AbstractAccel& sw, AbstractAccel* hw, Outcome& outcome) {
    const std::vector<Hit> software = timed(outcome.software_seconds, [&] { return sw.closest_hits(rays); });
    std::vector<Hit> hardware;
    if (hw) hardware = timed(outcome.hardware_seconds, [&] { return hw->closest_hits(rays); });
    const std::vector<Verdict> verdicts = classify_all(oracle, rays, software, hardware);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        outcome.software.add(*verdicts[i].software);
        if (is_fault_of_ours(*verdicts[i].software) && outcome.faulty.size() < max_printed_faults)
            outcome.faulty.push_back(rays[i]);
        if (!hw) continue;
        outcome.hardware.add(*verdicts[i].hardware);
        if (!is_same(software[i], hardware[i])) ++outcome.disagreements[{*verdicts[i].software, *verdicts[i].hardware}];
    }
}

void print_classes(const char* accel, const Classes& classes) {
    std::cout << "    " << accel;
    for (std::size_t kind = 0; kind < class_count; ++kind)
        if (const std::uint64_t n = classes[static_cast<Class>(kind)])
            std::cout << "  " << name(static_cast<Class>(kind)) << ' ' << n;
    std::cout << '\n';
}

void print_faulty(const std::vector<Ray>& rays) {
    for (const Ray& ray : rays)
        std::cout << std::hexfloat << "    faulty: origin " << ray.origin.x << ' ' << ray.origin.y << ' '
                  << ray.origin.z << " direction " << ray.direction.x << ' ' << ray.direction.y << ' '
                  << ray.direction.z << " t " << ray.t_min << ' ' << ray.t_max << std::defaultfloat << '\n';
}

void print(const RaySet& set, const Outcome& outcome, bool has_hardware) {
    const std::uint64_t faults = outcome.software.faults_of_ours();
    std::cout << "  " << set.name << ": " << set.rays.size() << " rays\n";
    print_classes("SW", outcome.software);
    std::cout << "        SW_LEAK " << outcome.software[Class::sw_leak] << ", SW_FALSE "
              << outcome.software[Class::sw_false] << ", T_ERR " << outcome.software[Class::t_err]
              << "; true rate below " << std::setprecision(2) << upper_bound_95(faults, set.rays.size()) << " (95 %)\n";
    print_faulty(outcome.faulty);
    if (!has_hardware) return;
    print_classes("HW", outcome.hardware);
    std::cout << "    SW and HW name different hits on " << outcome.disagreeing() << " rays\n";
    for (const auto& [classes, count] : outcome.disagreements)
        std::cout << "        SW " << name(classes.first) << ", HW " << name(classes.second) << ": " << count << '\n';
}

nlohmann::json counts_json(const Classes& classes) {
    nlohmann::json counts = nlohmann::json::object();
    for (std::size_t kind = 0; kind < class_count; ++kind)
        counts[std::string(name(static_cast<Class>(kind)))] = classes[static_cast<Class>(kind)];
    return counts;
}

struct Judgement {
    const char* backend;
    std::string path;
    const Classes& classes;
    std::uint64_t faults;
    const char* criterion;
    double seconds;
};

void append_record(const VerifyOptions& options, const Context& context, const RaySet& set, const Judgement& judged) {
    append_json(options.common.json, {{"schema", "twinray-report/1"},
                                      {"device", describe(context)},
                                      {"case", "verify." + set.name},
                                      {"scene", options.scene.string()},
                                      {"backend", judged.backend},
                                      {"path", judged.path},
                                      {"level", "watertight"},
                                      {"reference", "f64"},
                                      {"n", set.rays.size()},
                                      {"seed", options.common.seed},
                                      {"counts", counts_json(judged.classes)},
                                      {"bound95", upper_bound_95(judged.faults, set.rays.size())},
                                      {"seconds", judged.seconds},
                                      {"pass", judged.faults == 0},
                                      {"criterion", judged.criterion}});
}

void append_records(const VerifyOptions& options, const Context& context, const RaySet& set, const Outcome& outcome,
                    const HwTlas* hw) {
    append_record(options, context, set,
                  {"sw", "compute", outcome.software, outcome.software.faults_of_ours(),
                   "SW_LEAK, SW_FALSE and T_ERR are 0", outcome.software_seconds});
    if (hw)
        append_record(options, context, set,
                      {"hw", hw->trace_path(), outcome.hardware, outcome.hardware.faults_of_hardware(),
                       "HW_LEAK, HW_FALSE, HW_T_ERR and HW_RANGE are 0", outcome.hardware_seconds});
}

// Built, and its kernel compiled, so that what is timed is tracing.
void build(AbstractAccel& accel, const Scene& scene) {
    push_scene(accel, scene);
    const Ray ray{vec3(0), 0, vec3(1), 1};
    static_cast<void>(accel.closest_hits(std::span(&ray, 1)));
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

    std::cout << "verify " << options.scene.filename().string() << ": " << count_triangles(scene) << " triangles in "
              << scene.instances.size() << " instances, on " << context->facts().name << "; HwTlas by "
              << (hw ? hw->trace_path() : "nothing (unsupported on this device)") << '\n';
    std::uint64_t faults = 0;
    for (const RaySet& set : ray_sets(options, oracle, bounds_of(scene))) {
        Outcome outcome;
        Progress progress("verify " + set.name, set.rays.size(), options.common.quiet);
        for (std::size_t first = 0; first < set.rays.size(); first += batch_size) {
            const auto batch = std::span(set.rays).subspan(first, std::min(batch_size, set.rays.size() - first));
            judge(oracle, batch, sw, hw.get(), outcome);
            progress.advance(batch.size());
        }
        print(set, outcome, hw != nullptr);
        append_records(options, *context, set, outcome, hw.get());
        faults += outcome.software.faults_of_ours();
    }
    std::cout << (faults ? text(faults, " faults of ours") : std::string("no fault of ours")) << '\n';
    return faults;
}

}  // namespace

void add_verify(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("verify", "compare HwTlas, SwTlas and the float64 referee; exit 1 on a fault of ours");
    const auto options = std::make_shared<VerifyOptions>();
    command->add_option("scene", options->scene, ".gltf, .glb, .obj, .ply or .stl")->required();
    CLI::Option* rays = command->add_option("--rays", options->rays, "raw 32-byte rays, little endian");
    command->add_option("--random", options->random, "random rays")->capture_default_str()->excludes(rays);
    command->add_option("--aimed", options->aimed, "rays aimed at vertices, and as many aimed at edges")
        ->capture_default_str()
        ->excludes(rays);
    add_common_options(*command, options->common);
    command->callback([options, &exit_code] { exit_code = run(*options) ? 1 : 0; });
}

}  // namespace twinray::cli
