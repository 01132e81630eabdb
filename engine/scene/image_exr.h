// SPDX-License-Identifier: MIT
#pragma once

#include "engine/scene/image.h"

namespace twinray {

// The pixels of an OpenEXR file as stored. Throws Error naming the file.
HdrImage load_exr_image(const std::filesystem::path& file);

// Throws Error naming `object` when an image of this size is empty or over 2^28 pixels, beyond which a file is
// more likely damaged than meant.
void check_image_size(std::int64_t width, std::int64_t height, const std::string& object);

}  // namespace twinray
