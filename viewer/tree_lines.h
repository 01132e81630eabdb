// SPDX-License-Identifier: MIT
// The boxes of a tree, level by level, as lines.
#pragma once

#include <vector>

#include "validation/cpu_reference/reference_scene.h"
#include "viewer/picture/marks.h"

namespace twinray::viewer {

struct Box {
    dvec3 lo, hi;
    bool is_of_instances;  // of the scene's level; else of a geometry, under its instance's transform
    double share = 1;      // of the area of the root's box: of rays that meet the root, how many meet this (SAH)
};

// Boxes `depth` steps below the root, in world space; those of leaves that end before stay. Below the scene's level go
// on the trees of the instances. At most so many boxes; the rest is left out.
std::vector<Box> boxes_at(const Scene& scene, const reference::Scene& cpu_reference, int depth,
                          std::size_t most = 20000);

// The meaning of a box's colour.
enum class BoxColor : std::uint8_t {
    kind,  // blue of instances, orange of triangles
    area,  // Box::share, from 1e-4 to 1, on a logarithmic scale
};
// The twelve edges of each box.
std::vector<Stroke> strokes_of(const std::vector<Box>& boxes, BoxColor color = BoxColor::kind);

}  // namespace twinray::viewer
