// SPDX-License-Identifier: MIT
// Welds the vertices of a mesh at the same position, for the copy of positions that a tree keeps.
#pragma once

#include <span>

#include "engine/accel/geometry.h"

namespace twinray {

// Returns the mesh with one vertex for each position that triangles use, in their order, or nothing if that saves less
// than a sixteenth. Positions are equal if their bits are. Files often repeat a vertex: on both sides of a hard edge or
// of a seam of textures.
Welded weld(std::span<const vec3> positions, std::span<const uvec3> triangles);

}  // namespace twinray
