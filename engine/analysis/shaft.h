// SPDX-License-Identifier: MIT
// What can come between two polygons: pure functions.
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

    // Whether `face` may be in the way. False only where a plane parts it from the shaft: the axes are those of the
    // theorem of separating axes, so that what touches the shaft from outside is not in the way, as walls of a convex
    // room are not. A face that lies in the plane of a polygon and covers some of it is. What reaches into the shaft by
    // less than `rounding` does not count.
    bool may_be_blocked_by(const Polygon64& face, const PolygonBox& box_of_face) const;

  private:
    // A direction, and where the polygons lie along it.
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
