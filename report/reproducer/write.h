// SPDX-License-Identifier: MIT
// Reproducers of faults of drivers as folders.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <span>

#include "report/replay/replay.h"
#include "report/frame/devices.h"

namespace twinray::reproducer {

// How long one fault may take to be reduced.
inline constexpr double default_seconds = 5;

// Reduces the fault of the ray in the scene, both as they were traced, and writes the folder, which is made:
// reproducer.c, report.md, replay.json, scene.glb and the shaders as SPIR-V. `replay` tells the ray, the backend and
// which twinray it is; device and driver are those of now. Returns a sentence for the user. Throws Error where the
// fault is one of ours, where the driver shows none, and where a file cannot be written.
std::string write_reproducer(const std::filesystem::path& folder, const Scene& scene, const replay::Replay& replay,
                             frame::Devices& devices, double seconds = default_seconds);

// The same for a replay file.
std::string write_reproducer(const std::filesystem::path& folder, const std::filesystem::path& replay_file,
                             frame::Devices& devices, double seconds = default_seconds);

// Of the first fault of each class of the driver's that these replay files hold and the driver still shows, into
// `folder`/HW_LEAK, ...; files are tried in their order until `seconds` have passed in all. Prints a line for each.
// Returns how many folders were written. Faults of twinray, and of drivers that are not here, are passed over.
std::size_t write_reproducers(const std::filesystem::path& folder, std::span<const std::filesystem::path> replay_files,
                              frame::Devices& devices, std::ostream& out, double seconds = default_seconds);

}  // namespace twinray::reproducer
