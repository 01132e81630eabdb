// SPDX-License-Identifier: MIT
// Stands in for images that are missing.
#pragma once

#include <string>

#include <twinray/scene.h>

namespace twinray {

// Magenta and black squares: what stands in for an image that cannot be shown, so that nobody overlooks it.
Image checkerboard_image(const std::string& name);

}  // namespace twinray
