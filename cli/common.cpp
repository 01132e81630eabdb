#include "cli/common.h"

#include <cstdlib>
#include <fstream>
#include <iomanip>

#include "engine/scene/local_origin.h"

namespace twinray::cli {

Section common_options(CommonOptions& options) {
    const auto pipelines = [&options](std::span<const std::string> words) -> const std::string* {
        options.pipelines = words.front();
        return nullptr;
    };
    return {"Device and output",
            {{.name = "--device",
              .value = word(options.device, "DEVICE"),
              .help = "index of the device or part of its name, as `twinray devices` prints them; without it, the "
                      "fastest device"},
             {.name = "--seed",
              .value = number(options.seed),
              .help = "seed of the random numbers; the same seed gives the same results"},
             json_option(options.json),
             {.name = "--strict",
              .value = flag(options.strict),
              .help = "treat unsupported parts of a scene's file as errors, not as warnings"},
             {.name = "--quiet", .value = flag(options.quiet), .help = "print no progress and no warnings"},
             {.name = "--validation", .value = flag(options.validation), .help = "enable the Vulkan validation layer"},
             {.name = "--pipelines",
              .value = {.kind = Value::Kind::folder, .metavar = "FOLDER", .least = 1, .most = 1, .store = pipelines},
              .help = "folder in which compiled pipelines are kept between runs; \"\" keeps none; without it, "
                      "twinray's folder in the user's cache"}}};
}

Section with(Section section, std::vector<Option> more) {
    section.options.insert(section.options.end(), std::make_move_iterator(more.begin()),
                           std::make_move_iterator(more.end()));
    return section;
}

Option json_option(std::filesystem::path& path) {
    return {.name = "--json", .value = file(path), .help = "append the results to this file, one JSON object per line"};
}

Option scene_argument(std::filesystem::path& path) {
    Option scene{.value = file(path), .help = "scene file: .gltf, .glb, .obj, .ply or .stl", .is_required = true};
    scene.value.metavar = "SCENE";
    return scene;
}

Option output_option(Value value, const std::string& help) {
    return {.name = "--output", .letter = 'o', .value = std::move(value), .help = help};
}

Option accel_option(std::string& request, const std::string& what) {
    return {.name = "--accel",
            .value = choice(request, {"auto", "sw", "hw"}),
            .help = what +
                    ": sw (software, SwTlas), hw (hardware, HwTlas), or auto: hw if the device supports it and is not "
                    "a CPU, else sw; `twinray devices` prints what auto selects"};
}

Option level_option(Level& level, const std::string& help) {
    return {.name = "--level",
            .value = choice(level, names_of(all_levels)),
            .help = help +
                    ": watertight loses no ray at edges; fast may lose some and takes 0.9 to 1 of its time; refined "
                    "also computes t, u and v in float64 (1.02 to 1.11 of the time); certified decides hits and their "
                    "order in float64 (1.1 to 1.4 of the time, software accelerator only)"};
}

std::vector<Option> tree_options(AccelOptions& options) {
    return {{.name = "--layout",
             .value = choice(options.layout, names_of(all_layouts)),
             .help = "memory layout of the software accelerator's trees"},
            {.name = "--build-quality",
             .value = choice(options.build_quality, names_of(all_build_qualities)),
             .help = "build quality of the software accelerator's trees"}};
}

ContextDesc context_desc(const CommonOptions& options, double most_wait_seconds) {
    ContextDesc desc{.device = options.device,
                     .validation = options.validation,
                     .pipeline_folder = options.pipelines.value_or(user_pipeline_folder())};
    desc.most_wait_seconds = most_wait_seconds;
    if (options.quiet && !options.validation) desc.log = [](std::string_view) {};
    if (const char* disabled = std::getenv("TWINRAY_DISABLE")) disable_features(desc, disabled);
    return desc;
}

std::unique_ptr<Context> make_context(const CommonOptions& options) {
    return std::make_unique<Context>(context_desc(options));
}

std::unique_ptr<AbstractAccel> make_accel(Context& context, const AccelChoice& choice, const Scene& scene,
                                          Level level) {
    std::unique_ptr<AbstractAccel> accel =
        twinray::make_accel(context, choice, {.level = std::max(level, Level::watertight), .keeps_meshes = false});
    push_scene(*accel, scene);
    context.wait(accel->sync());
    return accel;
}

void heed_warnings(const Scene& scene, const std::string& name, const CommonOptions& options) {
    if (!options.quiet && scene.origin != dvec3(0))
        std::cerr << "twinray: scene moved to local origin " << origin_text(scene.origin) << '\n';
    if (!options.quiet || options.strict)
        for (const std::string& warning : scene.warnings) std::cerr << "twinray: warning: " << warning << '\n';
    if (options.strict && !scene.warnings.empty())
        fail("'", name, "': ", scene.warnings.size(), " warning(s), which --strict treats as errors");
}

Scene load_scene(const std::filesystem::path& file, const CommonOptions& options) {
    Scene scene = twinray::load_scene(file);
    heed_warnings(scene, file.string(), options);
    return scene;
}

std::string coordinate_text(double coordinate, double origin) {
    return text(std::setprecision(origin == 0 ? 6 : 12), coordinate + origin);
}

std::string coordinate_text(const dvec3& point, const dvec3& origin) {
    return text("(", coordinate_text(point.x, origin.x), ", ", coordinate_text(point.y, origin.y), ", ",
                coordinate_text(point.z, origin.z), ")");
}

nlohmann::json list_of(const dvec3& v) { return {v.x, v.y, v.z}; }

void check_writable(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(folder))
        fail("'", file.string(), "': there is no folder '", folder.string(), "'");
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    if (file.empty()) return;
    std::ofstream out(file);
    if (!(out << text).flush()) fail("'", file.string(), "' cannot be written");
}

void append_json(const std::filesystem::path& file, const nlohmann::json& record) {
    if (file.empty()) return;
    std::ofstream out(file, std::ios::app);
    out << record.dump() << '\n';
    if (!out.flush()) fail("JSON file '", file.string(), "' cannot be written");
}

nlohmann::json base_record(const char* schema, const Context& context, const std::filesystem::path& file,
                           const Scene& scene) {
    return {
        {"schema", schema}, {"device", describe(context)}, {"scene", file.string()}, {"origin", list_of(scene.origin)}};
}

nlohmann::json describe(const AccelChoice& choice) { return {{"backend", choice.name()}, {"backend_why", choice.why}}; }

std::string text_of(const AccelChoice& choice) { return text("by ", name_of(choice), " (", choice.why, ')'); }

}  // namespace twinray::cli
