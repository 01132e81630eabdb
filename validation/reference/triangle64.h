// SPDX-License-Identifier: MIT
// Ray against triangle in float64, for the reference.
#pragma once

#include <array>
#include <optional>

#include "twinray/glsl/cpp.h"

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

}  // namespace twinray
