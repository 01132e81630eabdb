// SPDX-License-Identifier: MIT
// `twinray collide`: instances whose boxes overlap.
#include <chrono>
#include <fstream>
#include <iostream>

#include "cli/common.h"
#include "engine/accel/scene_push.h"
#include "engine/collide/collision_finder.h"
#include "engine/core/error.h"

namespace twinray::cli {
namespace {

struct CollideOptions {
    CommonOptions common;
    std::filesystem::path scene, output;
    std::string accel = "sw";
    bool is_broad = false;
};

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void write_pairs(const std::filesystem::path& file, const std::vector<InstancePair>& pairs) {
    if (file.empty()) return;
    std::ofstream out(file);
    out << "instance_a,instance_b\n";
    for (const InstancePair& pair : pairs) out << pair.a << ',' << pair.b << '\n';
    if (!out.flush()) fail("CSV file '", file.string(), "' cannot be written");
}

void run_broad(const CollideOptions& options) {
    const Scene scene = load_scene_with_warnings(options.scene, options.common.quiet);
    const std::unique_ptr<Context> context = make_context(options.common);
    const std::unique_ptr<AbstractAccel> accel = make_accel(*context, options.accel);
    push_scene(*accel, scene);
    context->wait(accel->sync());
    CollisionFinder finder(*context);
    const Clock::time_point start = Clock::now();
    const std::vector<InstancePair> pairs = finder.instance_pairs(*accel);
    const double seconds = seconds_since(start);
    write_pairs(options.output, pairs);
    if (!options.common.quiet)
        std::cout << scene.instances.size() << " instances, " << pairs.size() << " pairs of boxes overlap, " << seconds
                  << " s with copies\n";
    append_json(options.common.json, {{"schema", "twinray-collide/1"},
                                      {"device", describe(*context)},
                                      {"scene", options.scene.string()},
                                      {"phase", "broad"},
                                      {"backend", options.accel},
                                      {"instances", scene.instances.size()},
                                      {"pairs", pairs.size()},
                                      {"seconds", seconds}});
}

void run(const CollideOptions& options) {
    if (!options.output.empty()) check_writable(options.output);
    if (!options.is_broad) fail("collide: only --broad is there");
    run_broad(options);
}

}  // namespace

void add_collide(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand("collide", "which instances and triangles of a scene touch or overlap");
    const auto options = std::make_shared<CollideOptions>();
    command->add_option("scene", options->scene, ".gltf, .glb, .obj, .ply or .stl")->required();
    command->add_flag("--broad", options->is_broad, "pairs of instances whose boxes overlap, nothing finer");
    command->add_option("-o,--output", options->output, "written: the pairs as CSV");
    command->add_option("--accel", options->accel, "whose boxes --broad takes; they are the same")
        ->check(CLI::IsMember({"sw", "hw"}))
        ->capture_default_str();
    add_common_options(*command, options->common);
    command->callback([options] { run(*options); });
}

}  // namespace twinray::cli
