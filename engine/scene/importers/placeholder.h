// SPDX-License-Identifier: MIT
// The replacement for missing images.
#pragma once

#include <string>

#include <twinray/scene.h>

namespace twinray {

// Magenta and black squares replace an image that cannot be shown, so that nobody overlooks it.
Image checkerboard_image(const std::string& name);

}  // namespace twinray
