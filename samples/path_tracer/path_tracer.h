// SPDX-License-Identifier: MIT
// The command line of the sample (options.cpp); the objects that it describes, scene, lights, camera, device and
// accelerators (session.cpp); a film that is rendered round by round until the stopping options are met, and saved and
// shown meanwhile (rendering.cpp); and reports about a run (report.cpp).
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <twinray/tlas.h>
#include <twinray/validation.h>
#include "renderer/cross_check.h"
#include "renderer/denoiser.h"
#include "renderer/environment.h"
#include "renderer/lights.h"
#include "renderer/moving_scene.h"
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

struct Rendering {
    Film film;
    HdrImage picture = {};  // the film as shown: its mean, without noise if that is wanted
    RenderStats stats = {};
    double resumed_samples = 0;  // samples of a pixel, on average, that the film had before
    int signal = 0;              // the one that ended it early; 0: none
};

// Returns the file for unfinished work: PICTURE.film beside a picture; a film is its own. Each of many ranks has its
// own: OUTPUT.rank0of2.film.
std::filesystem::path checkpoint_file(const std::filesystem::path& output, const Ranks& ranks);

// Reads and writes the files of the options: the checkpoint to resume from, checkpoints, pictures on the way, and at
// the end the output, for all ranks by rank 0. Throws Error naming the file.
Rendering render_film(const Options& options, const Session& session, AbstractAccel& accel, Ranks& ranks);

// Notes on a frame of a sequence.
struct FrameNote {
    uint number = 1, count = 1;
    double seconds = 0;                     // of the animation
    double build_ms = 0;                    // of the accelerator, before the first frame
    std::optional<MotionTimes> times = {};  // none: nothing moves but the camera
};

// Returns the device's time of the accelerator's last build or refit.
double build_ms(const AbstractAccel& accel);

// Prints one line per render, unless quiet, and warnings about dropped contributions. Appends the JSON record that the
// options request.
void report_render(const Options& options, const Session& session, const AbstractAccel& accel,
                   const Rendering& rendering, const FrameNote* frame = nullptr);

// Prints one line, unless quiet.
void report_merge(const MergeOptions& options, const Film& film);

// The result of one cross-check.
struct CrossCheck {
    std::string hardware_path;
    std::uint64_t path_rays = 0, shadow_rays = 0;
    std::uint64_t disagreeing = 0;
    std::uint64_t classified = 0;
    std::map<std::pair<HitClass, HitClass>, std::uint64_t> classes;  // (software, hardware) of the classified rays
    std::uint64_t faults_of_ours = 0;
    PictureDifference pictures;
    std::uint64_t pixel_count = 0;

    bool passed() const { return faults_of_ours == 0 && pictures.unexplained == 0; }
};

// Classifies each disagreeing ray by the float64 reference. `first` of each is hardware, `second` software.
void classify_disagreements(const Scene& scene, const std::vector<Disagreement>& disagreements, CrossCheck& result);

// Prints to stdout and writes the file: one JSON object if it ends in .json, else the text.
void report_cross_check(const Options& options, const Session& session, const CrossCheck& result);

}  // namespace twinray::path_tracer
