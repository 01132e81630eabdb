// SPDX-License-Identifier: MIT
// The obstacles that can be between two polygons: pure functions.
#pragma once

#include <optional>
#include <vector>

#include "engine/analysis/polygon64.h"

namespace twinray {

// The convex hull of two polygons that see each other, which holds every line from one to the other (Haines and
// Wallace, "Shaft culling for efficient ray-traced radiosity", 1991).
class Shaft {
  public:
    Shaft(const FacingPair& pair, double rounding);

    // Returns whether `face` may be in the way; false only if a plane separates it from the shaft. The axes are those
    // of the theorem of separating axes, so that a face that touches the shaft from outside is not in the way, such as
    // a wall of a convex room. A face that lies in the plane of a polygon and covers some of it is. A face that reaches
    // into the shaft by less than `rounding` does not count.
    bool may_be_blocked_by(const Polygon64& face, const PolygonBox& box_of_face) const;

  private:
    // A direction, and the range of the polygons along it.
    struct Axis {
        dvec3 unit;
        Extent a, b;
    };
    std::optional<Axis> axis_along(const dvec3& direction) const;
    void add_axis(const dvec3& direction);
    bool is_apart(const Polygon64& face, const Axis& axis) const;

    FacingPair pair_;
    double rounding_;
    PolygonBox box_;
    std::vector<dvec3> edges_;  // of the hull, and some within
    std::vector<Axis> axes_;    // normals of its faces, and some more
};

}  // namespace twinray
