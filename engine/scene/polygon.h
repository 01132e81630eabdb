// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "engine/core/shader_bridge.h"

namespace twinray {

// Cuts a simple polygon, convex or not, into corner_count - 2 triangles of the same winding. `corners` index
// `positions`. What is not simple, or has over 256 corners, is cut as a fan.
std::vector<uvec3> triangulate_polygon(std::span<const vec3> positions, std::span<const uint> corners);

}  // namespace twinray
