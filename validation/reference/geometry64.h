// SPDX-License-Identifier: MIT
// One mesh as the reference holds it: the active triangles and a hierarchy over them, in object space.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "engine/scene/mesh.h"
#include "validation/reference/bvh64.h"
#include "validation/reference/triangle64.h"

namespace twinray {

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
