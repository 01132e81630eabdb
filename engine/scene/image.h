// SPDX-License-Identifier: MIT
// Decoding of textures and of high dynamic range environment maps.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace twinray {

// Decodes PNG or JPEG; 16-bit channels are cut to 8, grey and RGB are widened to RGBA.
// Throws Error naming `object` and what the bytes seem to be when they are neither, damaged, or over 2^28 pixels.
Image decode_image(std::span<const std::uint8_t> bytes, const std::string& object);

// Magenta and black squares: what stands in for an image that cannot be shown, so that nobody overlooks it.
Image checkerboard_image(const std::string& name);

// Linear radiance, row 0 first (the top of an environment map).
struct HdrImage {
    uint width = 0;
    uint height = 0;
    std::vector<vec3> rgb;
};

// Reads .hdr (Radiance RGBE) or .exr (any OpenEXR compression, first part, R G B or Y), chosen by the suffix.
// So that a map can be sampled as light, infinities become the largest half (65504), NaN and negative values 0.
HdrImage load_hdr_image(const std::filesystem::path& file);

}  // namespace twinray
