// SPDX-License-Identifier: MIT
// `twinray leaks`: as many rays as one likes from inside a closed mesh at its vertices and edges, and no way out.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include <twinray/scene.h>

#include "cli/command/values.h"
#include "cli/commands.h"
#include "cli/common.h"
#include "cli/places.h"
#include "validation/suite/crossings.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/core/progress.h"
#include "engine/report/statistics.h"
#include "engine/verify/inside_rays.h"
#include <twinray/abstract_accel.h>

namespace twinray::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct LeaksOptions {
    CommonOptions common;
    std::filesystem::path scene, state;
    std::uint64_t rays = 1'000'000;
    std::string accel = "auto";
    Level level = Level::watertight;
};

suite::Subject subject_of(const LeaksOptions& options, const AccelChoice& choice) {
    return {choice.is_software ? suite::Backend::software : suite::Backend::ray_query, options.level};
}

constexpr std::size_t max_printed_faults = 20;
constexpr double seconds_between_saves = 1;

struct Totals {
    std::uint64_t rays = 0;
    std::uint64_t leaks = 0;
    std::uint64_t double_hits = 0;
    std::uint64_t unspecified = 0;
    double seconds = 0;

    std::uint64_t faults() const { return leaks + double_hits; }
};

// FNV-1a (Fowler, Noll, Vo) of all corners.
std::uint64_t hash_of(const Mesh& mesh) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            for (int axis = 0; axis < 3; ++axis)
                hash = (hash ^ std::bit_cast<std::uint32_t>(mesh.positions[triangle[corner]][axis])) * 0x100000001b3u;
    return hash;
}

// What a run must have in common with the one that it goes on from.
nlohmann::json identity_of(const LeaksOptions& options, const AccelChoice& choice, const Mesh& mesh,
                           const Context& context) {
    return {{"schema", "twinray-leaks/1"},     {"mesh", text(std::hex, hash_of(mesh))},
            {"seed", options.common.seed},     {"backend", choice.name()},
            {"level", name_of(options.level)}, {"device", describe(context)["name"]}};
}

Totals read_state(const std::filesystem::path& file, const nlohmann::json& identity) {
    std::ifstream in(file);
    const nlohmann::json state = nlohmann::json::parse(in, nullptr, false);
    if (!state.is_object()) fail("'", file.string(), "' holds no state of `twinray leaks`");
    for (const auto& [name, value] : identity.items())
        if (const nlohmann::json was = state.value(name, nlohmann::json()); was != value)
            fail("'", file.string(), "' is of another run: its ", name, " is ", was.dump(), ", not ", value.dump());
    try {
        return {state.at("rays"), state.at("leaks"), state.at("double_hits"), state.at("unspecified"),
                state.at("seconds")};
    } catch (const nlohmann::json::exception& error) {
        fail("'", file.string(), "': ", error.what());
    }
}

// Whole or not at all: whenever the process ends, the file is that of some batch's end.
void write_state(const std::filesystem::path& file, nlohmann::json state, const Totals& totals) {
    state.update({{"rays", totals.rays},
                  {"leaks", totals.leaks},
                  {"double_hits", totals.double_hits},
                  {"unspecified", totals.unspecified},
                  {"seconds", totals.seconds}});
    const std::filesystem::path unfinished = file.string() + ".unfinished";
    std::ofstream out(unfinished);
    out << state.dump(2) << '\n';
    if (!out.flush()) fail("state file '", unfinished.string(), "' cannot be written");
    out.close();
    std::filesystem::rename(unfinished, file);
}

void print_fault(std::uint64_t index, const Ray& ray, uint counted, Parity parity) {
    std::cout << "  " << (parity == Parity::leak ? "leak" : "double hit") << ", crossed " << counted << " times: ray "
              << index << std::hexfloat << ", origin " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z
              << " direction " << ray.direction.x << ' ' << ray.direction.y << ' ' << ray.direction.z
              << std::defaultfloat << std::endl;
}

class Run {
  public:
    Run(const LeaksOptions& options, const AccelChoice& choice, const Mesh& mesh, Context& context)
        : closed_(mesh),
          inside_(closed_, Aim::both, options.common.seed),
          counter_(context, subject_of(options, choice)),
          accel_(make_accel(context, choice, options.level)) {
        accel_->push(mesh, {}, {.filtered = true});
        accel_->sync();
    }

    void trace_batch(std::size_t count, Totals& totals) const {
        const std::vector<Ray> rays = inside_.rays(totals.rays, count);
        const std::vector<uint> counts = counter_.count(*accel_, rays);
        std::vector<Parity> parities(count);
        parallel_for(count, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) parities[i] = judge_crossings(closed_, rays[i], counts[i]);
        });
        for (std::size_t i = 0; i < count; ++i) {
            const bool is_fault = parities[i] == Parity::leak || parities[i] == Parity::double_hit;
            if (is_fault && totals.faults() < max_printed_faults)
                print_fault(totals.rays + i, rays[i], counts[i], parities[i]);
            totals.leaks += parities[i] == Parity::leak;
            totals.double_hits += parities[i] == Parity::double_hit;
            totals.unspecified += parities[i] == Parity::unspecified;
        }
        totals.rays += count;
    }

  private:
    ClosedMesh closed_;
    InsideRays inside_;
    suite::CrossingCounter counter_;
    std::unique_ptr<AbstractAccel> accel_;
};

Totals trace_all(const LeaksOptions& options, const Run& run, const nlohmann::json& identity, Totals totals) {
    constexpr std::size_t batch_size = 1 << 17;
    Progress progress("leaks", options.rays, options.common.quiet);
    progress.advance(std::min(totals.rays, options.rays));
    const auto begin = Clock::now();
    const double seconds_before = totals.seconds;
    double saved = 0;
    while (totals.rays < options.rays) {
        const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(batch_size, options.rays - totals.rays));
        run.trace_batch(count, totals);
        progress.advance(count);
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        totals.seconds = seconds_before + seconds;
        const bool is_due = seconds - saved > seconds_between_saves || totals.rays == options.rays;
        if (options.state.empty() || !is_due) continue;
        write_state(options.state, identity, totals);
        saved = seconds;
    }
    return totals;
}

void print(const AccelChoice& choice, const Totals& totals) {
    const char* whose = choice.is_software ? "ours" : "the driver's";
    std::cout << "  " << totals.rays << " rays: " << totals.leaks << " leaks, " << totals.double_hits
              << " double hits of " << whose;
    if (totals.unspecified) std::cout << "; " << totals.unspecified << " cannot be told: edge-on at the origin";
    std::cout << "\n  true rate below " << std::setprecision(2) << upper_bound_95(totals.faults(), totals.rays)
              << " (95 %); " << std::setprecision(3) << static_cast<double>(totals.rays) * 1e-6 / totals.seconds
              << " Mrays/s\n";
}

// Returns the faults of ours.
std::uint64_t run(const LeaksOptions& options) {
    if (!options.state.empty()) check_writable(options.state);
    const std::string file = options.scene.filename().string();
    const Scene scene = load_scene(options.scene, options.common);
    const Mesh mesh = joined(scene, file);
    const std::unique_ptr<Context> context = make_context(options.common);
    const AccelChoice choice =
        choose_accel(context->facts(), options.accel, {.level = options.level, .kernel_queries = true});
    const nlohmann::json identity = identity_of(options, choice, mesh, *context);
    const bool goes_on = !options.state.empty() && std::filesystem::exists(options.state);
    const Totals before = goes_on ? read_state(options.state, identity) : Totals();
    const Run leak_run(options, choice, mesh, *context);
    std::cout << "leaks " << file << ": closed, " << mesh.triangles.size() << " triangles; " << text_of(choice)
              << " at " << name_of(options.level) << " on " << context->facts().name << '\n';
    if (goes_on) std::cout << "  goes on after " << before.rays << " rays\n";

    const Totals totals = trace_all(options, leak_run, identity, before);
    print(choice, totals);
    append_json(options.common.json, {{"schema", "twinray-report/1"},
                                      {"device", describe(*context)},
                                      {"case", "leaks"},
                                      {"scene", options.scene.string()},
                                      {"origin", list_of(scene.origin)},
                                      {"backend", choice.name()},
                                      {"backend_why", choice.why},
                                      {"level", name_of(options.level)},
                                      {"reference", "analytic"},
                                      {"n", totals.rays},
                                      {"seed", options.common.seed},
                                      {"counts",
                                       {{"AGREE", totals.rays - totals.faults() - totals.unspecified},
                                        {"LEAK", totals.leaks},
                                        {"DOUBLE_HIT", totals.double_hits},
                                        {"UNSPECIFIED", totals.unspecified}}},
                                      {"faults", totals.faults()},
                                      {"bound95", upper_bound_95(totals.faults(), totals.rays)},
                                      {"seconds", totals.seconds},
                                      {"pass", totals.faults() == 0},
                                      {"criterion", "every ray crosses an odd number of triangles"}});
    return choice.is_software ? totals.faults() : 0;
}

}  // namespace

Command leaks_command() {
    const auto options = std::make_shared<LeaksOptions>();
    Option scene = scene_argument(options->scene);
    scene.help += ", in which every edge lies between two triangles";
    const Section rays = {"Rays",
                          {{.name = "--ray-count",
                            .value = number(options->rays, {.least = 1}),
                            .help = "how many rays in all",
                            .former_name = "--rays"},
                           {.name = "--state",
                            .value = file(options->state),
                            .help = "keep the state of the run in FILE, and go on from it if it is there",
                            .former_name = "--resume"},
                           accel_option(options->accel, "whose hits are counted"),
                           level_option(options->level)}};
    return {.name = "leaks",
            .group = "Checking",
            .summary = "shoot rays from inside a closed mesh: none may get out, none hit twice",
            .description =
                "Rays start inside a closed mesh and are aimed at its vertices and at points of its edges, "
                "where a test that is not watertight loses them. A ray that crosses an even number of "
                "triangles has leaked or was hit twice; no reference is needed to see it. Prints the first "
                "such rays bit by bit.",
            .positionals = {scene},
            .sections = {rays, common_options(options->common)},
            .examples = {{"twinray leaks torus.ply --ray-count 1e8 --state torus.json",
                          "a hundred million rays, in as many sittings as one likes"}},
            .fault = "a ray leaks or hits twice by the software accelerator",
            .run = [options] { return run(*options) > 0 ? 1 : 0; }};
}

}  // namespace twinray::cli
