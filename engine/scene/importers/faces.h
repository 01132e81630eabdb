// Makes triangles of the faces of a file: cuts polygons, and merges equal vertices.
#pragma once

#include "engine/core/interruption.h"
#include "engine/scene/mesh.h"
#include "twinray/glsl/cpp.h"

namespace twinray {

struct Triangulation {
    std::vector<uvec3> triangles;  // of vertex numbers, two fewer than vertices
    bool overlaps = false;         // the polygon crosses itself, so that some triangles face the other way
};

// Cuts a polygon, convex or not, into triangles of its winding that cover it once. Its outline may touch itself, such
// as where a slit leads to a hole. A polygon that crosses itself ends as a fan.
Triangulation triangulate_polygon(std::span<const dvec3> vertices);

// Cuts the faces of a file one after the other, and lists their faults.
class FaceCutter {
  public:
    // Returns triangles of vertex numbers until the next call; none below 3 vertices. Warnings name face `number`.
    const std::vector<uvec3>& cut(std::span<const dvec3> vertices, std::size_t number);
    // Returns a sentence for each kind of fault; `unit`: the numbering of faces, "line" or "face".
    std::vector<std::string> warnings(const std::string& unit) const;

  private:
    std::vector<uvec3> triangles_;
    std::size_t short_ = 0, overlapping_ = 0, first_overlapping_ = 0;
    LoopInterruption interruption_;
};

// Returns the same triangles over fewer vertices: those that are exactly equal in every attribute become one, the first
// of them (0 equals -0). There is no tolerance, which would have to be wrong for scenes far smaller or larger than it.
// Triangles keep their order and number, including those that are or become degenerate.
Mesh weld_equal_vertices(const Mesh& mesh);

// The same for a mesh in which each three vertices are a triangle; the triangles of `mesh` are ignored. Throws Error
// naming the mesh if there are over 2^32 vertices.
Mesh weld_unindexed(Mesh mesh);

}  // namespace twinray
