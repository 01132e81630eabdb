// Leaves of two triangles, for which a record has room as for one: half as many leaves, and nodes above them; and the
// copy of positions that a tree keeps for them, welded.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "engine/accel/geometry.h"
#include "swtlas/structures.h"

namespace twinray {

// Divides the triangles into leaves: two that share an edge, whose ends are apart, and whose common box is no larger
// than their own boxes together, or one. The first of a leaf is the one that comes first, and leaves are in the order
// of their first. Triangles that are near each other in `triangles` find each other, then those in space that are left.
// Empty if no two share a leaf.
std::vector<Leaf> pair_triangles(std::span<const vec3> positions, std::span<const uvec3> triangles);

// Gives a mesh in host memory the leaves, and the vertices, of the tree that takes the least memory. `has_vertices`:
// its own are in device memory anyway, for trees to name.
void choose_leaves(Geometry& geometry, bool has_vertices);

// Makes leaves of two triangles name vertices as `triangles` do.
void name_vertices(std::span<CompressedRecord> records, std::span<const uvec3> triangles);

// Returns whether leaves among the records of a tree have two triangles.
inline bool has_pairs(std::span<const CompressedRecord> records) {
    return std::ranges::any_of(records,
                               [](const CompressedRecord& record) { return is_leaf(record) && is_pair(record); });
}

// Returns the mesh with one vertex for each position that triangles use, in their order, or nothing if that saves less
// than a sixteenth. Positions are equal if their bits are. Files often repeat a vertex: on both sides of a hard edge or
// of a seam of textures.
Welded weld(std::span<const vec3> positions, std::span<const uvec3> triangles);

}  // namespace twinray
