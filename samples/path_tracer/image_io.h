// SPDX-License-Identifier: MIT
// Pictures to files.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "samples/path_tracer/shared.h"

namespace twinray::path_tracer {

// Where a part of a picture lies in the whole, in pixels.
struct PicturePart {
    uint x = 0, y = 0, whole_width = 0, whole_height = 0;
};

// Linear radiance, row 0 on top.
struct Picture {
    uint width = 0;
    uint height = 0;
    std::vector<vec3> rgb;
    std::optional<PicturePart> part = {};  // none: it is whole
};

// More of each pixel, row 0 on top: 32-bit float or unsigned integers.
struct Channel {
    std::string name;
    std::variant<std::vector<float>, std::vector<uint>> values;
};

// Exposure in stops that brings the geometric mean luminance of the pixels that are not black to a middle grey of 0.18.
float automatic_exposure(const Picture& picture);

// By suffix: .exr, linear 32-bit float, without exposure; .png, 8-bit sRGB, exposed and tone mapped with Khronos PBR
// Neutral. A part of a picture is the data window of an .exr whose display window is the whole. What was there before
// is replaced at the end. Throws Error naming the file. layers: channels for .exr.
void write_picture(const std::filesystem::path& file, const Picture& picture, float exposure,
                   std::span<const Channel> layers = {});

// Whether write_picture knows the suffix.
bool is_picture_file(const std::filesystem::path& file);

}  // namespace twinray::path_tracer
