// SPDX-License-Identifier: MIT
// What the subcommands share: options, making an accelerator, raw ray files, JSON lines.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/run.h"
#include "engine/accel/abstract_accel.h"
#include "engine/scene/scene.h"

namespace twinray::cli {

struct CommonOptions {
    std::string device;
    std::uint64_t seed = 1;
    std::filesystem::path json;
    bool quiet = false;
    bool validation = false;
    std::filesystem::path pipelines = user_pipeline_folder();
};
void add_common_options(CLI::App& command, CommonOptions& options);

std::map<std::string, Layout> layouts_by_name();
std::map<std::string, BuildQuality> build_qualities_by_name();
// --layout and --build-quality
void add_tree_options(CLI::App& command, AccelOptions& options);

// A context for these options; TWINRAY_DISABLE (a comma-separated list of ray_query, ray_tracing_pipeline) leaves
// features of the device unused.
ContextDesc context_desc(const CommonOptions& options);
std::unique_ptr<Context> make_context(const CommonOptions& options);

// kind: "sw" or "hw".
std::unique_ptr<AbstractAccel> make_accel(Context& context, const std::string& kind);

// Loads; prints where the origin is, if it was moved, and the warnings to stderr unless quiet.
Scene load_scene_with_warnings(const std::filesystem::path& file, bool quiet);
void print_notes(const Scene& scene, bool quiet);

void check_writable(const std::filesystem::path& file);  // its folder exists: before the work, not after it

// "1.4.305".
std::string api_version(const Context& context);

// Appends one line; does nothing for an empty path.
void append_json(const std::filesystem::path& file, const nlohmann::json& record);
nlohmann::json describe(const Context& context);

// Each adds its subcommand; the callback sets `exit_code`.
void add_collide(CLI::App& app, int& exit_code);
void add_devices(CLI::App& app, int& exit_code);
void add_distance(CLI::App& app, int& exit_code);
void add_trace(CLI::App& app, int& exit_code);
void add_verify(CLI::App& app, int& exit_code);
void add_leaks(CLI::App& app, int& exit_code);
void bench_moves(const CommonOptions& options, std::size_t count, std::size_t rounds);
void bench_ladder(const CommonOptions& options, const std::string& scene, const bench::RunOptions& run);
void add_bench(CLI::App& app, int& exit_code);
void add_illumination(CLI::App& app, int& exit_code);
void add_centroid(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);
void add_viewfactors(CLI::App& app, int& exit_code);

}  // namespace twinray::cli
