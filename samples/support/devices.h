// SPDX-License-Identifier: MIT
// Chooses a device on the command line.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <twinray/context.h>

namespace twinray::samples {

// Of the devices that twinray runs on and that the request names, by index or by a part of the name, the best: one with
// ray tracing hardware before others, then a discrete GPU, an integrated one, a virtual one, a CPU. None where none
// fits.
std::optional<std::size_t> best_device(std::span<const DeviceProperties> devices, const std::string& request = {});

}  // namespace twinray::samples
