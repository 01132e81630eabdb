// SPDX-License-Identifier: MIT
// Explains a faulty ray.
#pragma once

#include <filesystem>
#include <iosfwd>

#include "report/suite/devices.h"

namespace twinray::replay {

// Traces the ray of a replay file again on every accelerator of the device and tells step by step what each does and
// why it is right or wrong. True: SwTlas shows a fault of ours, still. Throws Error where the scene is not the one that
// the file names.
bool show(const std::filesystem::path& file, suite::Devices& devices, std::ostream& out);

}  // namespace twinray::replay
