// SPDX-License-Identifier: MIT
// Closed meshes: a ray from inside one crosses it an odd number of times, whatever its shape, so that no reference
// needs to find the hits.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "validation/reference/geometry64.h"

namespace twinray {

// An edge that an odd number of active triangles share.
struct OpenEdge {
    std::array<vec3, 2> vertices;
    uint primitive = 0;         // one of its triangles
    std::size_t triangles = 1;  // how many share it
};

// The open edge of the lowest primitive; nothing if the mesh is closed. Vertices are equal if their positions are, as
// for Vulkan. Two triangles a edge are usual; four, where two shells touch along it, also leave every ray an odd number
// of crossings. Orientation is of no account. Degenerate triangles are not counted: rays never hit them, so a
// T-junction that one of them bridges is open.
std::optional<OpenEdge> find_open_edge(const Geometry64& geometry);

class ClosedMesh {
  public:
    // Throws Error naming the mesh and an open edge, or that it has no active triangle.
    explicit ClosedMesh(const MeshView& mesh);

    const Geometry64& geometry() const { return geometry_; }

    // How often the ray crosses the mesh at t > 0. Exact up to float64, and counted twice where the ray passes an edge
    // exactly: choose a direction that does not.
    std::size_t crossings(const dvec3& origin, const dvec3& direction) const;
    // Whether a triangle comes closer than `distance` to the point, all in units of the mesh.
    bool comes_within(double distance, const dvec3& point) const;

    // Up to `count` points from which three random rays have an odd number of crossings, and which are farther from
    // every triangle than clearance(). Point i depends on (seed, i) alone; where 256 tries give none it is left out.
    // Throws Error naming the mesh when all are.
    std::vector<vec3> points_inside(std::size_t count, std::uint64_t seed) const;
    // 2^-14 of the largest of extents and coordinates: hundreds of float32 roundings.
    double clearance() const;

  private:
    std::optional<vec3> point_inside(std::uint64_t seed, std::uint64_t index) const;

    std::string name_;
    Geometry64 geometry_;
};

}  // namespace twinray
