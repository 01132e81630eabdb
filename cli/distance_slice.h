// SPDX-License-Identifier: MIT
// `twinray distance --slice`: distances in a plane as a picture.
#pragma once

#include "cli/command/command.h"
#include "engine/picture/slice_picture.h"
#include "engine/points/point_finder.h"
#include "engine/scene/scene.h"

namespace twinray::cli {

struct SliceOptions {
    std::filesystem::path file;  // .png; empty: none
    SliceDesc desc = {};         // in the file's coordinates
};
Section slice_options(SliceOptions& options);

// Throws Error for a scene without triangles. `is_signed`: negative inside, as signed_distances() tells.
void write_slice(const SliceOptions& options, const Scene& scene, PointFinder& finder, bool is_signed,
                 const std::string& title);

}  // namespace twinray::cli
