// SPDX-License-Identifier: MIT
// `twinray trace`: a file of rays in, a file of hits out.
#include <algorithm>
#include <chrono>
#include <iostream>

#include "cli/common.h"
#include "cli/places.h"
#include "cli/ray_file.h"
#include "engine/accel/all_hits.h"
#include "engine/accel/scene_push.h"
#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/progress.h"

namespace twinray::cli {
namespace {

struct TraceOptions {
    CommonOptions common;
    std::filesystem::path scene, rays, hits, counts;
    std::string accel = "hw";
    std::string query = "closest";
    std::string level = "watertight";
};

constexpr std::size_t batch_size = 1 << 20;

// The hits of all rays, one after the other; writes how many each has.
std::vector<Hit> trace_all(AbstractAccel& accel, std::span<const Ray> rays, const TraceOptions& options) {
    HitsOfRays found = AllHits(accel)(rays);
    std::vector<std::uint32_t> counts;
    for (std::size_t i = 0; i < rays.size(); ++i)
        counts.push_back(static_cast<std::uint32_t>(found.first[i + 1] - found.first[i]));
    const std::span<const std::byte> piece = std::as_bytes(std::span(counts));
    write_file(options.counts, std::span(&piece, 1));
    return std::move(found.hits);
}

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
    const bool is_all = options.query == "all";
    if (is_all == options.counts.empty())
        fail(is_all ? "--query all needs --counts: which hits are of which ray" : "--counts is for --query all");
    check_writable(options.hits);
    if (is_all) check_writable(options.counts);
    const Scene scene = load_scene_with_warnings(options.scene, options.common.quiet);
    const std::vector<Ray> rays = read_rays(options.rays, scene.origin);
    const std::unique_ptr<Context> context = make_context(options.common);
    const std::unique_ptr<AbstractAccel> accel = make_accel(*context, options.accel);
    push_scene(*accel, scene);
    context->wait(accel->sync());
    const auto start = std::chrono::steady_clock::now();
    const std::vector<Hit> hits = is_all ? trace_all(*accel, rays, options) : trace_in_batches(*accel, rays, options);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    write_hits(options.hits, hits);
    const auto found = std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.hit != 0; });
    if (!options.common.quiet)
        std::cout << rays.size() << " rays, " << found << " hits, " << seconds << " s with copies\n";
    append_json(options.common.json, {{"schema", "twinray-trace/1"},
                                      {"device", describe(*context)},
                                      {"scene", options.scene.string()},
                                      {"origin", list_of(scene.origin)},
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
    command->add_option("--rays", options->rays, "raw 32-byte rays, little endian, or .npy: N x 8 numbers, float64 too")
        ->required();
    command->add_option("--hits", options->hits, "written: raw 32-byte hits")->required();
    command->add_option("--accel", options->accel)->check(CLI::IsMember({"sw", "hw"}))->capture_default_str();
    command->add_option("--query", options->query)
        ->check(CLI::IsMember({"closest", "any", "all"}))
        ->capture_default_str();
    command->add_option("--counts", options->counts,
                        "written, of all hits: raw 32-bit counts by ray; the hits of a ray are ascending by t");
    command->add_option("--level", options->level)->check(CLI::IsMember({"watertight"}))->capture_default_str();
    add_common_options(*command, options->common);
    command->callback([options] { run(*options); });
}

}  // namespace twinray::cli
