// SPDX-License-Identifier: MIT
// `twinray distance --slice`: distances in a plane as a picture.
#pragma once

#include <twinray/queries.h>

#include "cli/command/command.h"
#include <twinray/scene.h>


namespace twinray::cli {

struct SliceOptions {
    std::filesystem::path file;  // .png; empty: none
    char axis = 'z';             // that the plane is perpendicular to
    std::optional<double> at;    // the plane's place along it; none: the middle of the scene
    uint width = 480;            // pixels of the larger side, a point each
};
Section slice_options(SliceOptions& options);

// Throws Error for a scene without triangles. `is_signed`: negative inside, as signed_distances() tells.
void write_slice(const SliceOptions& options, const Scene& scene, PointQuery& query, bool is_signed,
                 const std::string& title);

}  // namespace twinray::cli
