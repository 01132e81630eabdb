// Closed meshes: a ray from inside one crosses it an odd number of times, whatever its shape, so that no reference
// needs to find the hits. Rays from inside, aimed where intersection tests break, and what their crossings say.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/ray.h"
#include "validation/reference/geometry64.h"

namespace twinray {

// An edge that an odd number of active triangles share.
struct OpenEdge {
    std::array<vec3, 2> vertices;
    uint primitive = 0;         // one of its triangles
    std::size_t triangles = 1;  // how many share it
};

// Returns the open edge of the lowest primitive; nothing if the mesh is closed. Vertices are equal if their positions
// are, as for Vulkan. Two triangles per edge are usual; four, where two shells touch along it, also leave every ray an
// odd number of crossings. Orientation does not matter. Degenerate triangles are not counted: rays never hit them, so a
// T-junction that one of them bridges is open.
std::optional<OpenEdge> find_open_edge(const Geometry64& geometry);

class ClosedMesh {
  public:
    // Throws Error naming the mesh and an open edge, or that it has no active triangle.
    explicit ClosedMesh(const MeshView& mesh);

    const Geometry64& geometry() const { return geometry_; }

    // Returns how often the ray crosses the mesh at t > 0. It is exact up to float64; a crossing exactly at an edge
    // counts twice, so choose a direction without one.
    std::size_t crossings(const dvec3& origin, const dvec3& direction) const;
    // Returns whether a triangle comes closer than `distance` to the point, all in units of the mesh.
    bool comes_within(double distance, const dvec3& point) const;

    // Returns up to `count` points from which three random rays have an odd number of crossings, and which are farther
    // from every triangle than clearance(). Point i depends only on (seed, i); it is left out if 256 tries give none.
    // Throws Error naming the mesh if all are left out.
    std::vector<vec3> points_inside(std::size_t count, std::uint64_t seed) const;
    // Returns 2^-14 of the largest of extents and coordinates: hundreds of float32 roundings.
    double clearance() const;

  private:
    std::optional<vec3> point_inside(std::uint64_t seed, std::uint64_t index) const;

    std::string name_;
    Geometry64 geometry_;
};

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
