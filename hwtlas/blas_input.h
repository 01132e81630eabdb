// SPDX-License-Identifier: MIT
// What the driver is given for a mesh. Pure functions.
#pragma once

#include <vector>

#include "engine/accel/geometry.h"

namespace twinray {

// Only finite positions, one triangle per triangle of the mesh: one that is not active (a non-finite vertex, no area)
// keeps its index but is collapsed to a point. Vulkan has no word for an infinite vertex, and a driver may let a NaN
// leak into the boxes of the triangles beside it, or hit triangles without area.
struct BlasInput {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    std::vector<Bounds> boxes;   // instead of both
    Bounds bounds;               // of the active primitives
    std::vector<uint> original;  // index in `triangles` or `boxes` -> the user's index; empty: not reordered

    bool is_empty() const { return bounds.is_empty(); }  // there is nothing that could be hit
};

BlasInput blas_input(const Geometry& geometry, bool reorder);

}  // namespace twinray
