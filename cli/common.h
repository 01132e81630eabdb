// SPDX-License-Identifier: MIT
// Shared by the commands: options, making an accelerator, coordinates of files, JSON lines.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/command/command.h"
#include <twinray/tlas.h>
#include "twinray/glsl/cpp.h"
#include "validation/records/recorded_device.h"

namespace twinray {
class AbstractAccel;
class Context;
struct AccelOptions;
struct ContextDesc;
struct Hit;
struct Ray;
struct Scene;
}  // namespace twinray

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
// leaves features of the device unused.
ContextDesc context_desc(const CommonOptions& options);
std::unique_ptr<Context> make_context(const CommonOptions& options);
// These are for commands that check drivers, which may hang: nothing that they submit takes so many seconds.
inline constexpr double most_suite_seconds = 300, most_conformance_seconds = 60;
ContextDesc watched_context_desc(const CommonOptions& options, double most_wait_seconds);

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

}  // namespace twinray::cli
