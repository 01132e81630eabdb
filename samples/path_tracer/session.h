// SPDX-License-Identifier: MIT
// The command line of the sample, and the objects that it describes: scene, lights, camera, device and accelerators.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <twinray/tlas.h>
#include "renderer/denoiser.h"
#include "renderer/environment.h"
#include "renderer/lights.h"
#include "renderer/renderer.h"
#include "renderer/rounds.h"
#include "renderer/sequence.h"
#include "samples/support/program.h"
#include "samples/support/ranks.h"

namespace twinray::path_tracer {
using samples::Ranks;

struct Options : samples::DeviceOptions {
    std::filesystem::path scene, output, environment, json, cross_check, reference;
    std::optional<std::uint32_t> samples;
    std::optional<double> seconds, target_error;
    std::string shard;           // "i/N"
    std::string display_server;  // HOST[:PORT]; "": none
    std::optional<double> preview_seconds;
    std::optional<double> checkpoint_seconds = 60;
    bool resume = false;
    bool keep_film = false;
    bool aovs = false;
    bool denoise = false;
    std::vector<float> crop;                 // fractions x0 x1 y0 y1; none: all
    std::vector<double> look_from, look_at;  // in the file's coordinates
    std::vector<float> up = {0, 1, 0};
    float fov = 40;  // degrees, vertical
    float lens_radius = 0;
    std::optional<float> focal_distance;  // none: to look_at
    std::string filter = "gaussian";
    std::uint32_t width = 0;   // 0: from the camera's aspect and the height, else 640
    std::uint32_t height = 0;  // 0: 480
    std::uint32_t max_depth = 8;
    std::uint32_t seed = 1;
    std::string variant;  // of the materials; "": the file's own
    SequenceOptions sequence;
    int camera = 0;                 // -1: frame the scene
    std::optional<float> exposure;  // stops; none: 0 under the default sky, else automatic
    bool strict = false;
    bool stats = false;
    bool all_features = false;
    bool view = false;
};

// `path_tracer merge`.
struct MergeOptions {
    std::vector<std::filesystem::path> films;
    std::filesystem::path output, reference;
    std::optional<float> exposure;
    bool quiet = false;
};

// The options, or the exit status of a finished run: help was shown (0) or the usage is wrong (2).
struct ParsedOptions {
    Options options;
    std::optional<MergeOptions> merge;  // set: this was asked for
    std::optional<int> exit_status;
};
ParsedOptions parse_options(int argc, char** argv);

// Keeps compiled pipelines in the user's folder.
ContextDesc context_desc(const Options& options);

struct Session {
    Scene scene;
    LocalLights lights;
    std::unique_ptr<EnvironmentMap> environment;  // null: black
    RenderSettings settings;
    StoppingRules rules;
    Shard shard;
    Configuration configuration;
    std::unique_ptr<const Denoiser> denoiser;  // null: noise stays
    std::unique_ptr<Context> context;
    AccelChoice accel;  // the accelerator that traces, and why
    std::unique_ptr<DeviceScene> device_scene;
    std::unique_ptr<Renderer> renderer;
};

// Call it before the work, not after it. Throws Error if there is no folder for the file.
void check_folder(const std::filesystem::path& file);

// Throws Error naming the file, the option and the limit.
Session make_session(const Options& options, const Ranks& ranks);

// Returns the camera that the options choose; one that frames the scene if is_framing().
Camera camera_of(const Options& options, const Scene& scene, const RenderSettings& settings);
bool is_framing(const Options& options, const Scene& scene);
// Uses the lens of the options.
CameraRays rays_of(const Options& options, const Camera& camera, const RenderSettings& settings);

// Returns an accelerator that holds the scene, built.
std::unique_ptr<AbstractAccel> make_accel(Context& context, const Scene& scene, const AccelChoice& choice);

// Returns "compute", "ray query" or "ray tracing pipeline".
std::string trace_path(const AbstractAccel& accel);

}  // namespace twinray::path_tracer
