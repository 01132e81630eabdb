// SPDX-License-Identifier: MIT
// The boxes of a tree, level by level, as lines.
#pragma once

#include <vector>

#include "validation/cpu_reference/reference_scene.h"
#include "viewer/picture/marks.h"

namespace twinray::viewer {

struct Box {
    dvec3 lo, hi;
    bool is_of_instances;  // a box of the scene's level; else of a geometry, under its instance's transform
    double share = 1;      // of the area of the root's box: the share of rays through the root that meet this box (SAH)
};

// Returns the boxes `depth` steps below the root, in world space; boxes of leaves that end before stay. The trees of
// the instances continue below the scene's level. Returns at most so many boxes and leaves out the rest.
std::vector<Box> boxes_at(const Scene& scene, const reference::Scene& cpu_reference, int depth,
                          std::size_t most = 20000);

// The meaning of a box's colour.
enum class BoxColor : std::uint8_t {
    kind,  // blue of instances, orange of triangles
    area,  // Box::share, from 1e-4 to 1, on a logarithmic scale
};
// Returns the twelve edges of each box.
std::vector<Stroke> strokes_of(const std::vector<Box>& boxes, BoxColor color = BoxColor::kind);

}  // namespace twinray::viewer
