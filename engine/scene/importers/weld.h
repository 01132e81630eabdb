// SPDX-License-Identifier: MIT
// Merges equal vertices.
#pragma once

#include "engine/scene/mesh.h"

namespace twinray {

// Returns the same triangles over fewer vertices: those that are exactly equal in every attribute become one, the first
// of them (0 equals -0). There is no tolerance, which would have to be wrong for scenes far smaller or larger than it.
// Triangles keep their order and number, including those that are or become degenerate.
Mesh weld_equal_vertices(const Mesh& mesh);

// The same for a mesh in which each three vertices are a triangle; the triangles of `mesh` are ignored. Throws Error
// naming the mesh if there are over 2^32 vertices.
Mesh weld_unindexed(Mesh mesh);

}  // namespace twinray
