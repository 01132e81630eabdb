// SPDX-License-Identifier: MIT
// Welds the vertices of a mesh that lie at one place, for the copy of positions that a tree keeps.
#pragma once

#include <span>

#include "engine/accel/geometry.h"

namespace twinray {

// The mesh with one vertex for each position that triangles use, in their order, or nothing where that saves less than
// a sixteenth. Positions are equal if their bits are. Files have many a vertex several times: on both sides of a hard
// edge, of a seam of textures.
Welded weld(std::span<const vec3> positions, std::span<const uvec3> triangles);

}  // namespace twinray
