// SPDX-License-Identifier: MIT
// Reproducers of drivers' faults, as folders.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <span>

#include "report/replay/replay.h"
#include "report/frame/devices.h"

namespace twinray::reproducer {

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
