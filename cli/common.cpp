// SPDX-License-Identifier: MIT
#include "cli/common.h"

#include <cstdlib>
#include <fstream>
#include <iostream>

#include "engine/core/error.h"
#include "engine/scene/local_origin.h"
#include "hwtlas/hw_tlas.h"
#include "swtlas/sw_tlas.h"

namespace twinray::cli {

void add_common_options(CLI::App& command, CommonOptions& options) {
    command.add_option("--device", options.device, "index or part of the name (see `twinray devices`)");
    command.add_option("--seed", options.seed, "seed of random rays")->capture_default_str();
    command.add_option("--json", options.json, "append results to FILE, one JSON object a line");
    command.add_flag("--quiet", options.quiet, "no progress, no warnings");
    command.add_flag("--validation", options.validation, "run under the Vulkan validation layer");
    command
        .add_option("--pipelines", options.pipelines, "folder that keeps compiled pipelines between runs; \"\": none")
        ->capture_default_str();
}

std::map<std::string, Layout> layouts_by_name() {
    std::map<std::string, Layout> layouts;
    for (const Layout layout : all_layouts) layouts.emplace(name_of(layout), layout);
    return layouts;
}

std::map<std::string, BuildQuality> build_qualities_by_name() {
    std::map<std::string, BuildQuality> qualities;
    for (const BuildQuality quality : all_build_qualities) qualities.emplace(name_of(quality), quality);
    return qualities;
}

void add_tree_options(CLI::App& command, AccelOptions& options) {
    command
        .add_option("--layout", options.layout,
                    "of the software accelerator's trees: compressed4 (the default), bvh2 or bvh4")
        ->transform(CLI::CheckedTransformer(layouts_by_name()));
    command
        .add_option("--build-quality", options.build_quality,
                    "of the software accelerator's trees: fast (the default) or high")
        ->transform(CLI::CheckedTransformer(build_qualities_by_name()));
}

ContextDesc context_desc(const CommonOptions& options) {
    ContextDesc desc{.device = options.device, .validation = options.validation, .pipeline_folder = options.pipelines};
    if (options.quiet && !options.validation) desc.log = [](std::string_view) {};
    if (const char* disabled = std::getenv("TWINRAY_DISABLE")) disable_features(desc, disabled);
    return desc;
}

std::unique_ptr<Context> make_context(const CommonOptions& options) {
    return std::make_unique<Context>(context_desc(options));
}

std::unique_ptr<AbstractAccel> make_accel(Context& context, const std::string& kind) {
    if (kind == "hw") return std::make_unique<HwTlas>(context);
    return std::make_unique<SwTlas>(context);
}

Scene load_scene_with_warnings(const std::filesystem::path& file, bool quiet) {
    Scene scene = load_scene(file);
    print_notes(scene, quiet);
    return scene;
}

void print_notes(const Scene& scene, bool quiet) {
    if (quiet) return;
    if (scene.origin != dvec3(0))
        std::cerr << "twinray: scene moved to local origin " << origin_text(scene.origin) << '\n';
    for (const std::string& warning : scene.warnings) std::cerr << "twinray: warning: " << warning << '\n';
}

void check_writable(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(folder))
        fail("'", file.string(), "': there is no folder '", folder.string(), "'");
}

void append_json(const std::filesystem::path& file, const nlohmann::json& record) {
    if (file.empty()) return;
    std::ofstream out(file, std::ios::app);
    out << record.dump() << '\n';
    if (!out.flush()) fail("JSON file '", file.string(), "' cannot be written");
}

std::string api_version(const Context& context) {
    const std::uint32_t api = context.facts().api_version;
    return text(VK_API_VERSION_MAJOR(api), ".", VK_API_VERSION_MINOR(api), ".", VK_API_VERSION_PATCH(api));
}

nlohmann::json describe(const Context& context) {
    return {{"name", context.facts().name}, {"driver", context.facts().driver}, {"api", api_version(context)}};
}

}  // namespace twinray::cli
