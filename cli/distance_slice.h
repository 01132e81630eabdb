// SPDX-License-Identifier: MIT
// `twinray distance --slice`: distances in a plane as a picture.
#pragma once

#include <twinray/queries.h>

#include "cli/command/command.h"
#include <twinray/scene.h>

#include "viewer/picture/slice_picture.h"

namespace twinray::cli {

struct SliceOptions {
    std::filesystem::path file;  // .png; empty: none
    SliceDesc desc = {};         // in the file's coordinates
};
Section slice_options(SliceOptions& options);

// Throws Error for a scene without triangles. `is_signed`: negative inside, as signed_distances() tells.
void write_slice(const SliceOptions& options, const Scene& scene, PointQuery& query, bool is_signed,
                 const std::string& title);

}  // namespace twinray::cli
