// SPDX-License-Identifier: MIT
// The mean of what is seen of a scene along a direction.
#pragma once

#include <optional>

#include "engine/analysis/ray_grid.h"
#include "engine/core/progress.h"

namespace twinray {

struct CentroidDesc {
    RayGridDesc grid;
    bool keeps_points = false;
    Progress* progress = nullptr;  // told of rays
};

// In world space, in float64 from float32 vertices, transforms and hits.
struct Centroid {
    std::uint64_t ray_count = 0;
    std::uint64_t point_count = 0;  // rays that hit
    std::optional<dvec3> mean;      // of the closest points of all rays; none where nothing is hit
    // Of `mean`, by axis, and on average not below; only with GridPoints::random, for centers are not independent.
    std::optional<dvec3> standard_error;
    std::vector<dvec3> points;  // in the order of the rays; empty unless CentroidDesc::keeps_points
};

// Traces the rays of the grid through an accelerator that push_scene() has filled from `scene`. The same desc gives the
// same bits on one device. Throws Error where plan_ray_grid does, and for an accelerator of another scene.
Centroid centroid(AbstractAccel& accel, const Scene& scene, const CentroidDesc& desc);

}  // namespace twinray
