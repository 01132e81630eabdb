// SPDX-License-Identifier: MIT
// The closest hit of a scene in rational arithmetic: the last word where float64 cannot tell.
#pragma once

#include <vector>

#include "validation/exact/triangle.h"
#include "engine/verify/oracle.h"

namespace twinray::exact {

struct TriangleId {
    uint instance = 0;
    uint primitive = 0;

    auto operator<=>(const TriangleId&) const = default;
};

struct ClosestHit {
    Crossing crossing;
    // All triangles that the ray meets at exactly this t, ascending: more than one at a shared edge or corner, or where
    // triangles coincide. The first is the closest hit by the rule of lowest (instance, primitive).
    std::vector<TriangleId> triangles;
};

// The line of a ray in the object space of an instance: the matrix as it was given, exactly inverted.
Line object_line(const Ray& ray, const Placement64& placement);

// Answers by the same rules as the Oracle that it reads the scene from (see oracle.h), but triangles are closed: a ray
// through an edge or a corner meets all triangles that have it. The hierarchy only leaves out what the ray misses by
// more than float64's rounding. Threads may share it.
class Referee {
  public:
    // The oracle must outlive it.
    explicit Referee(const Oracle& oracle) : oracle_(oracle) {}

    std::optional<ClosestHit> closest_hit(const Ray& ray) const;
    // The same from testing every triangle.
    std::optional<ClosestHit> closest_hit_brute_force(const Ray& ray) const;

  private:
    const Oracle& oracle_;
};

// As the float64 referee would say it: t, u and v rounded once.
OracleHit to_float64(const std::optional<ClosestHit>& hit, const Oracle& oracle);

}  // namespace twinray::exact
