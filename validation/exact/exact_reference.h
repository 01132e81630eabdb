// SPDX-License-Identifier: MIT
// The closest hit of a scene in rational arithmetic: the last word where float64 cannot tell.
#pragma once

#include <vector>

#include "validation/exact/triangle.h"
#include "validation/reference/reference_scene.h"

namespace twinray::exact {

struct TriangleId {
    uint instance = 0;
    uint primitive = 0;

    auto operator<=>(const TriangleId&) const = default;
};

struct ClosestHit {
    Crossing crossing;
    // All triangles that the ray meets at exactly this t, ascending: more than one at a shared edge or vertex, or where
    // triangles coincide. The first is the closest hit by the rule of lowest (instance, primitive).
    std::vector<TriangleId> triangles;
};

// Returns the line of a ray in the object space of an instance, by the exact inverse of the matrix as it was given.
Line object_line(const Ray& ray, const Placement64& placement);

// Answers by the same rules as the reference that it reads the scene from (see reference_scene.h), but triangles are
// closed: a ray through an edge or a vertex meets all triangles that have it. The hierarchy only leaves out what the
// ray misses by more than float64's rounding. Threads may share it.
class Reference {
  public:
    // The reference must outlive it.
    explicit Reference(const ReferenceScene& reference) : reference_(reference) {}

    std::optional<ClosestHit> closest_hit(const Ray& ray) const;
    // Returns the exact closest hit in the form of the float64 reference, with t, u and v rounded once.
    ReferenceHit rounded_hit(const Ray& ray) const;
    // Returns the same as closest_hit(), by testing every triangle.
    std::optional<ClosestHit> closest_hit_brute_force(const Ray& ray) const;

  private:
    const ReferenceScene& reference_;
};

// Converts a hit to the form of the float64 reference: t, u and v are rounded once.
ReferenceHit to_float64(const std::optional<ClosestHit>& hit, const ReferenceScene& reference);

}  // namespace twinray::exact
