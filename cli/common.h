// Shared by the commands, each of which is in the file of its name: options, making an accelerator, coordinates of
// files, JSON lines.
#pragma once

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include <twinray/scene.h>
#include <twinray/tlas.h>
#include "cli/command/values.h"
#include "engine/core/error.h"
#include "twinray/glsl/cpp.h"
#include "validation/records/recorder.h"

namespace twinray::cli {

struct CommonOptions {
    std::string device;
    std::uint64_t seed = 1;
    std::filesystem::path json;
    bool quiet = false;
    bool strict = false;
    bool validation = false;
    std::optional<std::filesystem::path> pipelines;  // none: the user's folder for them
};
Section common_options(CommonOptions& options);
// Returns the section with further options.
Section with(Section section, std::vector<Option> more);

Option json_option(std::filesystem::path& file);
// Returns the positional SCENE, the scene that a command asks about.
Option scene_argument(std::filesystem::path& file);
// Returns "-o, --output".
Option output_option(Value value, const std::string& help);
// Returns --accel auto|sw|hw, for choose_accel(). `what`: "what traces".
Option accel_option(std::string& request, const std::string& what = "accelerator that traces");
// Returns --level, which says what each level costs.
Option level_option(Level& level, const std::string& help = "precision of the triangle test");
// Returns --layout and --build-quality.
std::vector<Option> tree_options(AccelOptions& options);

// Describes a context for these options; TWINRAY_DISABLE (a comma-separated list of ray_query, ray_tracing_pipeline)
// leaves features of the device unused. Commands that check drivers, which may hang, give the number of seconds that
// nothing which they submit takes; 0: no limit.
ContextDesc context_desc(const CommonOptions& options, double most_wait_seconds = 0);
inline constexpr double most_suite_seconds = 300, most_conformance_seconds = 60;
std::unique_ptr<Context> make_context(const CommonOptions& options);

// Makes an accelerator that holds the scene, built.
std::unique_ptr<AbstractAccel> make_accel(Context& context, const AccelChoice& choice, const Scene& scene,
                                          Level level = Level::watertight);

// Prints the importer's warnings to stderr unless quiet. With --strict they are an Error.
Scene load_scene(const std::filesystem::path& file, const CommonOptions& options);
void heed_warnings(const Scene& scene, const std::string& name, const CommonOptions& options);

// Returns "(1, 0, 0)": where this point of the scene is in its file, with the digits that large coordinates need.
std::string coordinate_text(const dvec3& point, const dvec3& origin);
std::string coordinate_text(double coordinate, double origin);
nlohmann::json list_of(const dvec3& v);  // [x, y, z]

void check_writable(const std::filesystem::path& file);  // its folder exists; call it before the work, not after it

// Writes a file; does nothing for an empty path.
void write_text(const std::filesystem::path& file, const std::string& text);
// Appends one line; does nothing for an empty path.
void append_json(const std::filesystem::path& file, const nlohmann::json& record);
// Returns the fields with which records of a scene begin: "schema", "device", "scene" and "origin".
nlohmann::json base_record(const char* schema, const Context& context, const std::filesystem::path& file,
                           const Scene& scene);
nlohmann::json describe(const AccelChoice& choice);  // "backend" and "backend_why"
// Returns "by SwTlas (device 'llvmpipe' is a CPU, without hardware for rays)".
std::string text_of(const AccelChoice& choice);

// Returns the commands in the order of the list.
std::vector<Command> all_commands();

#ifdef TWINRAY_HAS_BENCH
Command bench_command();
#endif
#ifdef TWINRAY_HAS_REPORT
Command qualify_command();
Command report_command();
#endif
Command centroid_command();
Command collide_command();
Command completion_command();  // of help.cpp
Command devices_command();
Command distance_command();
Command help_command(const std::vector<std::string>& names);
Command illumination_command();
Command kernels_command();
Command leaks_command();
Command trace_command();
Command verify_command();
Command view_command();
Command viewfactors_command();
Command visible_command();

}  // namespace twinray::cli
