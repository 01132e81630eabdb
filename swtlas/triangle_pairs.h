// SPDX-License-Identifier: MIT
// Leaves of two triangles, which records of a tree hold as easily as one: half as many leaves, and nodes above them.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "engine/scene/mesh.h"
#include "swtlas/structures.h"

namespace twinray {

// A partition of the triangles into leaves, see make_leaf() of shaders/shared/build.h: two that share an edge, and
// whose common box is no larger than their own boxes together, or one. Triangles that are near each other in
// `triangles` find each other. Empty where a tree of such leaves and the positions that they name would take no less
// memory than a tree of a leaf for each triangle, which holds its vertices.
std::vector<uint> pair_triangles(std::span<const vec3> positions, std::span<const uvec3> triangles);

// Whether leaves among the records of a tree have two triangles.
inline bool has_pairs(std::span<const CompressedRecord> records) {
    return std::ranges::any_of(records,
                               [](const CompressedRecord& record) { return is_leaf(record) && is_pair(record); });
}

}  // namespace twinray
