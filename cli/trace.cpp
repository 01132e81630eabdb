// SPDX-License-Identifier: MIT
// `twinray trace`: a file of rays in, a file of hits out.
#include <algorithm>
#include <chrono>
#include <iostream>

#include "cli/common.h"
#include "engine/accel/scene_push.h"
#include "engine/core/progress.h"

namespace twinray::cli {
namespace {

struct TraceOptions {
    CommonOptions common;
    std::filesystem::path scene, rays, hits;
    std::string accel = "hw";
    std::string query = "closest";
    std::string level = "watertight";
};

constexpr std::size_t batch_size = 1 << 20;

std::vector<Hit> trace_in_batches(AbstractAccel& accel, std::span<const Ray> rays, const TraceOptions& options) {
    std::vector<Hit> hits;
    hits.reserve(rays.size());
    Progress progress("trace", rays.size(), options.common.quiet);
    for (std::size_t first = 0; first < rays.size(); first += batch_size) {
        const auto batch = rays.subspan(first, std::min(batch_size, rays.size() - first));
        const std::vector<Hit> some = options.query == "any" ? accel.any_hits(batch) : accel.closest_hits(batch);
        hits.insert(hits.end(), some.begin(), some.end());
        progress.advance(batch.size());
    }
    return hits;
}

void run(const TraceOptions& options) {
    check_writable(options.hits);
    const Scene scene = load_scene_with_warnings(options.scene, options.common.quiet);
    const std::vector<Ray> rays = read_rays(options.rays);
    const std::unique_ptr<Context> context = make_context(options.common);
    const std::unique_ptr<AbstractAccel> accel = make_accel(*context, options.accel);
    push_scene(*accel, scene);
    context->wait(accel->sync());
    const auto start = std::chrono::steady_clock::now();
    const std::vector<Hit> hits = trace_in_batches(*accel, rays, options);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    write_hits(options.hits, hits);
    const auto found = std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.hit != 0; });
    if (!options.common.quiet)
        std::cout << rays.size() << " rays, " << found << " hits, " << seconds << " s with copies\n";
    append_json(options.common.json, {{"schema", "twinray-trace/1"},
                                      {"device", describe(*context)},
                                      {"scene", options.scene.string()},
                                      {"backend", options.accel},
                                      {"level", options.level},
                                      {"query", options.query},
                                      {"n", rays.size()},
                                      {"hits", found},
                                      {"seconds", seconds}});
}

}  // namespace

void add_trace(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand("trace", "trace a file of rays");
    const auto options = std::make_shared<TraceOptions>();
    command->add_option("scene", options->scene, ".gltf, .glb, .obj, .ply or .stl")->required();
    command->add_option("--rays", options->rays, "raw 32-byte rays, little endian")->required();
    command->add_option("--hits", options->hits, "written: raw 32-byte hits")->required();
    command->add_option("--accel", options->accel)->check(CLI::IsMember({"sw", "hw"}))->capture_default_str();
    command->add_option("--query", options->query)->check(CLI::IsMember({"closest", "any"}))->capture_default_str();
    command->add_option("--level", options->level)->check(CLI::IsMember({"watertight"}))->capture_default_str();
    add_common_options(*command, options->common);
    command->callback([options] { run(*options); });
}

}  // namespace twinray::cli
