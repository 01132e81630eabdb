// Ray against triangle and distances of points in float64, and one mesh as the reference holds it: the active triangles
// and a hierarchy over them, in object space.
#pragma once

#include <algorithm>
#include <optional>

#include "engine/scene/mesh.h"
#include "validation/reference/bvh64.h"

namespace twinray {

using Triangle64 = std::array<dvec3, 3>;

struct TriangleHit64 {
    double t = 0;  // in units of the ray's direction
    double u = 0;  // the point is (1-u-v) v0 + u v1 + v v2
    double v = 0;
    bool along = false;  // the ray runs along (v1 - v0) x (v2 - v0), and so sees the triangle from behind
};

// Returns whether the three points span an area, decided exactly for every float32 input (NaN and infinity: false).
bool has_area(const std::array<vec3, 3>& triangle);

// The watertight test of Woop, Benthin and Wald 2013 ("Watertight Ray/Triangle Intersection", JCGT 2(1)) in
// float64, with zero counting as inside. Every triangle that shares a vertex sees it at the same sheared position,
// so a ray through a shared edge or vertex hits at least one of its triangles. Its float32 inputs span 1e-45 to
// 3e38; products of four of them stay inside the range of float64. Build without contraction (-ffp-contract=off).
class ShearedRay {
  public:
    ShearedRay(const dvec3& origin, const dvec3& direction);

    // Finds any t, also negative. Triangles seen exactly edge-on are missed; their neighbours own the ray.
    std::optional<TriangleHit64> intersect(const Triangle64& triangle) const;

  private:
    dvec3 project(const dvec3& point) const;

    dvec3 origin_;
    ivec3 axes_;  // the last one is the direction's longest
    dvec3 shear_;
};

// A vertex as a key: vertices are equal if their positions are, as for Vulkan, and -0 equals 0.
using VertexKey = std::array<float, 3>;
inline VertexKey key_of(const vec3& p) { return {p.x, p.y, p.z}; }

// Returns twice the signed area of the triangle (0, a, b): positive where b is counterclockwise of a.
inline double cross2(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

// Returns the distance of a point to the segment from a to b, in the plane (dvec2) or in space (dvec3).
template <class Point>
double distance_to_segment(const Point& a, const Point& b, const Point& point) {
    const Point edge = b - a;
    const double square = dot(edge, edge);
    const double along = square > 0 ? std::clamp(dot(point - a, edge) / square, 0.0, 1.0) : 0.0;
    return length(a + along * edge - point);
}

// Returns the distance of a point to a triangle that has an area.
inline double distance_to_triangle(const std::array<dvec3, 3>& vertices, const dvec3& point) {
    const dvec3 normal = cross(vertices[1] - vertices[0], vertices[2] - vertices[0]);
    bool is_above = true;  // the triangle, along its normal
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 &a = vertices[i], &b = vertices[(i + 1) % 3];
        is_above = is_above && dot(cross(b - a, point - a), normal) >= 0;
        nearest = std::min(nearest, distance_to_segment(a, b, point));
    }
    return is_above ? std::abs(dot(point - vertices[0], normalize(normal))) : nearest;
}

inline constexpr double unlimited = std::numeric_limits<double>::infinity();  // end of an interval of t

// A ray in a geometry's object space, prepared for its boxes and triangles.
struct ObjectRay {
    SlabRay slabs;
    ShearedRay sheared;

    // scale: largest coordinate of what it will be tested against. The pad covers, with a wide margin, the
    // few roundings (2^-53 each) by which the triangle test accepts rays just outside a triangle.
    ObjectRay(const dvec3& origin, const dvec3& direction, double scale);
};

// A triangle that rays can hit: finite, not degenerate.
struct ActiveTriangle {
    std::array<vec3, 3> vertices;
    uint primitive = 0;  // position in the mesh's triangle list

    Triangle64 vertices64() const;
    // The hit's t lies inside both `clip` and the triangle's own box: see bvh64.h for why.
    std::optional<TriangleHit64> intersect(const ObjectRay& ray, const Interval64& clip) const;
};

class Geometry64 {
  public:
    // Copies what it needs. Throws Error naming the mesh, the triangle and the limit if an index is out of range.
    explicit Geometry64(const MeshView& mesh);

    std::size_t triangle_count() const { return slots_.size(); }
    const Box64& bounds() const { return bvh_.bounds(); }  // of the active triangles
    std::span<const ActiveTriangle> active() const { return triangles_; }
    // Returns nullptr if the primitive is out of range, not finite or degenerate.
    const ActiveTriangle* find(uint primitive) const;

    // Calls visit(const ActiveTriangle&) for those whose boxes the ray may meet within [t_min, t_limit], until it
    // returns false.
    template <class Visit>
    void visit(const SlabRay& ray, double t_min, const double& t_limit, Visit&& visit) const {
        bvh_.visit_leaves(ray, t_min, t_limit, [&](uint first, uint last) {
            for (uint i = first; i < last; ++i)
                if (!visit(triangles_[i])) return false;
            return true;
        });
    }

  private:
    std::vector<ActiveTriangle> triangles_;  // in leaf order
    std::vector<uint> slots_;                // primitive -> position in triangles_
    Bvh64 bvh_;
};

}  // namespace twinray
