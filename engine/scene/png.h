// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>

#include "engine/scene/rgb.h"

namespace twinray {

// `pixels`: width * height of them, row 0 on top. Whole or not at all; throws Error naming the file.
void write_png(const std::filesystem::path& file, uint width, uint height, std::span<const Rgb> pixels);

}  // namespace twinray
