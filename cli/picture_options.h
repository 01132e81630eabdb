// SPDX-License-Identifier: MIT
// --picture and what belongs to it: the scene of a command in colours, as .png or .glb.
#pragma once

#include "cli/common.h"
#include "viewer/picture/marks.h"
#include "viewer/picture/page.h"
#include "viewer/picture/scene_picture.h"

namespace twinray::cli {

// --picture and the others, which need it. `shows`: what colours tell.
Section picture_options(PictureOptions& options, const std::string& shows);
// For commands whose colours show values.
Option color_scale_option(PictureOptions& options);
// Throws Error where a file has no folder: before the work, not after it.
void check_pictures(const PictureOptions& options);

}  // namespace twinray::cli
