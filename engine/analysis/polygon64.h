// Faces as convex polygons in float64: the part of one on the front side of the plane of another, the exchange of two,
// and the obstacles that can be between them. Pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "twinray/glsl/cpp.h"

namespace twinray {

// A triangle, or the part of it that a plane leaves. Vertices are counter-clockwise as seen from its front.
struct Polygon64 {
    std::array<dvec3, 4> vertices = {};
    std::size_t count = 0;

    Polygon64() = default;
    Polygon64(const dvec3& a, const dvec3& b, const dvec3& c) : vertices{a, b, c}, count(3) {}
    void add(const dvec3& vertex) { vertices[count++] = vertex; }
    std::span<const dvec3> points() const { return {vertices.data(), count}; }
    const dvec3& after(std::size_t i) const { return vertices[(i + 1) % count]; }
    // Returns the normal vector with the length of the area.
    dvec3 area_vector() const;
    double area() const { return length(area_vector()); }
    double longest_edge() const;
    dvec3 center() const;  // of the vertices
    // Returns the polygon seen from the other side.
    Polygon64 flipped() const;
};

// The range of the points along an axis.
struct Extent {
    double low = std::numeric_limits<double>::infinity(), high = -low;

    Extent with(const Extent& other) const { return {std::min(low, other.low), std::max(high, other.high)}; }
    double length() const { return high - low; }
    double gap_to(const Extent& other) const { return std::max(low - other.high, other.low - high); }  // or below 0
};
Extent extent_of(const Polygon64& polygon, const dvec3& axis);

struct PolygonBox {
    dvec3 low, high;
};
PolygonBox box_of(const Polygon64& polygon);  // the polygon has vertices

// Returns the largest error of a coordinate after a few operations on numbers as large as `size`.
double rounding_of(double size);

// Returns the part of `polygon` on the side of the plane of `triangle` from which that is counter-clockwise; empty if
// the part is an edge, or less. Vertices within `rounding` of the plane are in it.
Polygon64 before(const Polygon64& polygon, const Polygon64& triangle, double rounding);

// The parts of two triangles that see each other from their counter-clockwise sides; empty if none do.
struct FacingPair {
    Polygon64 a, b;
    bool is_empty() const { return a.count == 0 || b.count == 0; }
};
FacingPair facing_parts(const Polygon64& a, const Polygon64& b, double rounding);

// Returns the largest distance of a point of `polygon` from the plane of `other`, on the front side of that.
double height_before(const Polygon64& polygon, const Polygon64& other);

// Returns a lower bound of their distance over the longest edge of both.
double gap_over_size(const Polygon64& a, const Polygon64& b);

// The exchange of two polygons that see all of each other, by Stokes' theorem.
struct ContourExchange {
    double flow = 0;                // A F, from either to the other
    double error = 0;               // bound of the errors of the quadrature and of rounding
    std::uint64_t evaluations = 0;  // of ln r along an edge
};

// Returns A F = 1 / (2 pi) of the integral of ln r dr_a . dr_b along both contours (Sparrow, "A new and simpler
// formulation for radiative angle factors", 1963). For two edges it is taken in closed form along the longer one; along
// the other by a pair of rules of Gauss and Kronrod on pieces that are halved until both agree within rounding, which
// also finds the logarithms at vertices and edges that polygons share. Each polygon is on the front side of the other's
// plane, see facing_parts(); edges may be as short as the remains of a vertex after that.
ContourExchange contour_exchange(const Polygon64& a, const Polygon64& b);

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
