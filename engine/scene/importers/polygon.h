// SPDX-License-Identifier: MIT
// Polygons into triangles.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "twinray/glsl/cpp.h"

namespace twinray {

struct Triangulation {
    std::vector<uvec3> triangles;  // of vertex numbers, two fewer than vertices
    bool overlaps = false;         // the polygon crosses itself, so that some triangles face the other way
};

// Cuts a polygon, convex or not, into triangles of its winding that cover it once. Its outline may touch itself, as
// where a hole is reached by a slit. What crosses itself ends as a fan.
Triangulation triangulate_polygon(std::span<const dvec3> vertices);

// The faces of a file, cut one after the other, and what was wrong with them.
class FaceCutter {
  public:
    // Of vertex numbers, until the next call; none of fewer than 3 vertices. `number`: by which warnings name the face.
    const std::vector<uvec3>& cut(std::span<const dvec3> vertices, std::size_t number);
    // A sentence for each kind of fault; `unit`: what faces are numbered by, "line" or "face".
    std::vector<std::string> warnings(const std::string& unit) const;

  private:
    std::vector<uvec3> triangles_;
    std::size_t short_ = 0, overlapping_ = 0, first_overlapping_ = 0;
};

}  // namespace twinray
