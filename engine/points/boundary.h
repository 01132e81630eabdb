// Tells whether a mesh has an inside.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/mesh.h"

namespace twinray {

// An edge that triangles pass more often in one direction than in the other.
struct BoundaryEdge {
    std::array<vec3, 2> ends;
    uint triangle = 0;  // the lowest that has the edge; it
    uint vertex = 0;    // passes the edge from this vertex of its own to the next,
    int passes = 0;     // and triangles pass it so much more often that way than back; below 0: less often
};

// Returns these edges. Without any, every point that is not on the mesh has a winding number. Vertices are identical if
// their positions are. Triangles with a vertex that is not finite do not count.
std::vector<BoundaryEdge> boundary_edges(const MeshView& mesh);
// Returns the edge of the lowest triangle; nothing if there is none.
std::optional<BoundaryEdge> find_boundary_edge(const MeshView& mesh);

// Says why points have no side to a mesh, naming an edge and the mesh (by number if it has no name); "" if they have.
std::string side_fault_of(const MeshView& mesh, uint number);

}  // namespace twinray
