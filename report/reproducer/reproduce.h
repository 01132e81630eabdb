// A faulty ray of the driver in as small a scene as shows it, as a folder with a text for the driver's tracker.
#pragma once

#include <filesystem>
#include <iosfwd>

#include "report/frame/devices.h"
#include "report/replay/replay.h"
#include "report/reproducer/program.h"

namespace twinray::reproducer {

struct Reproduction {
    Scene scene;
    Ray ray{};
    frame::Backend backend{};
    HitClass kind{};
    Hit answer{};  // of the driver
    RightAnswers right;
    std::size_t triangles_before = 0;
    bool was_cut_short = false;  // by the limit of time: a smaller scene may exist
};

// Traces the ray and, if the answer is a fault, makes the scene smaller and its numbers shorter for at most this many
// seconds. Throws Error if the driver's own answer, before anything refines it, is not a fault. Apart from the limit,
// the result depends only on the arguments and the driver.
Reproduction reproduce(frame::Devices& devices, frame::Backend backend, const Scene& scene, const Ray& ray,
                       double seconds);

// Returns Markdown. `replay`: that of the reduced scene.
std::string page_text(const Reproduction& found, const replay::Replay& replay);

// Returns "a miss", or the triangle with t, u and v.
std::string words_of(const Hit& answer);

// How long the reduction of one fault may take.
inline constexpr double default_seconds = 5;

// Reduces the fault of the ray in the scene, both as they were traced, and writes the folder, which it makes:
// reproducer.c, report.md, replay.json, scene.glb and the shaders as SPIR-V. `replay` has the ray, the backend and the
// version of twinray; device and driver are the current ones. Returns a sentence for the user. Throws Error if the
// fault is one of ours, if the driver shows none, or if a file cannot be written.
std::string write_reproducer(const std::filesystem::path& folder, const Scene& scene, const replay::Replay& replay,
                             frame::Devices& devices, double seconds = default_seconds);

// Does the same for a replay file.
std::string write_reproducer(const std::filesystem::path& folder, const std::filesystem::path& replay_file,
                             frame::Devices& devices, double seconds = default_seconds);

// Writes a reproducer of the first fault of each class of the driver's faults that these replay files hold and the
// driver still shows, into `folder`/HW_LEAK, ...; tries the files in their order until `seconds` have passed in all.
// Prints a line for each. Returns how many folders were written. Skips faults of twinray, and of drivers that are not
// here.
std::size_t write_reproducers(const std::filesystem::path& folder, std::span<const std::filesystem::path> replay_files,
                              frame::Devices& devices, std::ostream& out, double seconds = default_seconds);

}  // namespace twinray::reproducer
