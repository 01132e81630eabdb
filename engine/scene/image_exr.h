// SPDX-License-Identifier: MIT
// OpenEXR files.
#pragma once

#include <twinray/scene.h>

namespace twinray {

// The pixels of an OpenEXR file as stored. Throws Error naming the file.
HdrImage load_exr_image(const std::filesystem::path& file);

// Writes linear 32-bit float, and channels beside them; a part of an image as the data window of the whole's display
// window. Throws Error that says why it cannot.
void write_exr_image(const std::filesystem::path& file, const HdrImage& image, std::span<const ImageChannel> channels);

// Throws Error naming `object` if an image of this size is empty or over 2^28 pixels, beyond which a file is more
// likely damaged than meant.
void check_image_size(std::int64_t width, std::int64_t height, const std::string& object);

}  // namespace twinray
