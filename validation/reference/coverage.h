// SPDX-License-Identifier: MIT
// Can rounding let a ray slip between the triangles of one instance?
#pragma once

#include <span>

#include "validation/reference/error_bounds.h"

namespace twinray {

struct PatchTriangle {
    std::array<vec3, 3> vertices;  // shared vertices are recognised by equal positions, as Vulkan does
    TriangleBound bound;
};

enum class Coverage {
    certain,     // however the vertices are displaced, the ray hits one of the triangles
    open,        // some ray within the radius misses them all: a silhouette or the rim of an open mesh
    unresolved,  // neither: only edges that meet without sharing their vertices close the way (T-junction,
                 // non-manifold edge)
};

// The patch must hold every triangle of one instance, in the wanted depth range, that comes within the
// largest radius of the ray. A triangle that contains the ray by more than its radius is certain. Otherwise:
// a kernel that treats a shared vertex alike in all its triangles sees a map of displaced vertices, each off by up
// to the radius. Take triangles that are joined along all edges near the ray, oriented alike. Their common boundary
// stays away from the ray under every such displacement, so the number of times they wind around the ray - the
// degree of the map - cannot change; if it is not 0, one of them contains the ray always.
Coverage coverage(std::span<const PatchTriangle> patch);

}  // namespace twinray
