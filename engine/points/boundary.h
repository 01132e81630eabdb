// SPDX-License-Identifier: MIT
// Whether a mesh has an inside.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/mesh.h"

namespace twinray {

// An edge that triangles pass more often from one end to the other than back.
struct BoundaryEdge {
    std::array<vec3, 2> ends;
    uint triangle = 0;  // the lowest that has it, which
    uint vertex = 0;    // passes it from this vertex of its to the next,
    int passes = 0;     // and how much more often triangles do so than back; below 0: less often
};

// Without any a point that is not on the mesh has a winding number. Vertices are one if their positions are. Triangles
// with a vertex that is not finite do not count.
std::vector<BoundaryEdge> boundary_edges(const MeshView& mesh);
// That of the lowest triangle; nothing if there is none.
std::optional<BoundaryEdge> find_boundary_edge(const MeshView& mesh);

// Why points have no side to a mesh, naming it, by its number where it has no name, and an edge; "" if they have.
std::string side_fault_of(const MeshView& mesh, uint number);

}  // namespace twinray
