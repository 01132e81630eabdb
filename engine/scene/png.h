// SPDX-License-Identifier: MIT
// Encodes pictures as PNG in memory.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <twinray/scene.h>

namespace twinray {

// `pixels`: width * height of them, row 0 on top.
std::vector<std::byte> encode_png(uint width, uint height, std::span<const Rgb> pixels);

}  // namespace twinray
