// SPDX-License-Identifier: MIT
// The leak test: rays from inside a closed mesh, aimed where intersection tests break, and what their crossings say.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/ray.h"
#include "validation/leaks/closed_mesh.h"

namespace twinray {

enum class Aim : std::uint8_t {
    vertices,  // a vertex of a random active triangle
    edges,     // a random point of one of its edges
    both,      // in turns
};

class InsideRays {
  public:
    // Starts rays from up to `origins` points inside. Keeps a reference to `mesh`. Throws as points_inside does.
    InsideRays(const ClosedMesh& mesh, Aim aim, std::uint64_t seed, std::size_t origins = 1024);

    // Returns ray `index`, which otherwise depends only on (mesh, aim, seed, origins): length 1 up to rounding, t in
    // (0, infinity), past its target within float32 rounding.
    Ray ray(std::uint64_t index) const;
    // Returns rays [first, first + count), made on all cores.
    std::vector<Ray> rays(std::uint64_t first, std::size_t count) const;

  private:
    const ClosedMesh& mesh_;
    Aim aim_;
    std::uint64_t seed_;
    std::vector<vec3> origins_;
};

// Judges a count of a ray's crossings, if the ray starts inside.
enum class Parity : std::uint8_t {
    odd,          // as it must be
    leak,         // even, and fewer than the reference's
    double_hit,   // even, and more
    unspecified,  // even, but rounding decides whether a triangle seen edge-on lies before or behind the origin
};

// Tells which crossings are missing or too many by the reference's count for a ray turned by 2^-40, off all edges.
// At a silhouette that is one of two right counts, so there leak and double_hit may stand for each other.
Parity check_crossings(const ClosedMesh& mesh, const Ray& ray, std::size_t counted);

}  // namespace twinray
