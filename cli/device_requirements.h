// SPDX-License-Identifier: MIT
// `twinray devices --requirements`: what twinray needs, by its parts, and which device has it.
#pragma once

#include <filesystem>
#include <span>

#include <twinray/context.h>

namespace twinray::cli {

void print_requirements(std::span<const DeviceProperties> devices, const std::filesystem::path& json);

}  // namespace twinray::cli
