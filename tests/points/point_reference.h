// Distances and winding numbers by other methods than the engine's, over all triangles.
#pragma once

#include <numbers>

#include "engine/collide/pair_class.h"
#include "engine/collide/triangle_set.h"
#include "tests/validation/reference/meshes.h"

namespace twinray::test {

namespace quadruple {

using Real = __float128;  // 113 bits of mantissa

struct Vector {
    Real x, y, z;

    explicit Vector(const dvec3& v) : x(v.x), y(v.y), z(v.z) {}
    Vector(Real a, Real b, Real c) : x(a), y(b), z(c) {}
};
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Real dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Real squared_distance_to_segment(const Vector& p, const Vector& a, const Vector& b) {
    const Vector ab = b - a, ap = p - a;
    const Real squared = dot(ab, ab);
    const Real along = squared > 0 ? std::clamp<Real>(dot(ap, ab) / squared, 0, 1) : 0;
    const Vector left(ap.x - along * ab.x, ap.y - along * ab.y, ap.z - along * ab.z);
    return dot(left, left);
}

}  // namespace quadruple

// A triangle in world space.
struct PlacedTriangle {
    WorldTriangle vertices;
    uint instance = 0, triangle = 0;
    bool is_mirrored = false;
};
inline std::vector<PlacedTriangle> placed_triangles(std::span<const MeshView> meshes,
                                                    std::span<const MeshInstance> instances) {
    std::vector<PlacedTriangle> all;
    for (uint i = 0; i < instances.size(); ++i) {
        const MeshView& mesh = meshes[instances[i].mesh];
        const Transform& m = instances[i].transform;
        for (uint t = 0; t < mesh.triangles.size(); ++t) {
            const uvec3 of = mesh.triangles[t];
            const auto point = [&](uint vertex) {
                const vec3 p = mesh.positions[vertex];
                const auto row = [&](std::size_t axis) {
                    const dvec4 r(m.rows[axis]);
                    return ((r.x * p.x + r.y * p.y) + r.z * p.z) + r.w;
                };
                return dvec3(row(0), row(1), row(2));
            };
            all.push_back({{point(of.x), point(of.y), point(of.z)}, i, t, determinant(m) < 0});
        }
    }
    return all;
}

// Returns points that are uniform in the cube [-size, size]^3.
inline std::vector<dvec3> random_points(std::size_t count, float size, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<dvec3> points(count);
    for (dvec3& point : points) point = dvec3(uniform3(random, -size, size));
    return points;
}

// Returns the distance by Voronoi regions (Ericson, "Real-Time Collision Detection", 2005, 5.1.5), in numbers of 113
// bits of mantissa; for triangles without area, the least of the distances from their edges.
inline long double distance(const dvec3& point, const WorldTriangle& triangle) {
    using quadruple::Real, quadruple::Vector, quadruple::squared_distance_to_segment;
    const Vector p(point), a(triangle.a), b(triangle.b), c(triangle.c);
    const Vector ab = b - a, ac = c - a, normal = cross(ab, ac);
    const Real d1 = dot(ab, p - a), d2 = dot(ac, p - a), d3 = dot(ab, p - b), d4 = dot(ac, p - b);
    const Real d5 = dot(ab, p - c), d6 = dot(ac, p - c);
    const Real va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    const Real height = dot(normal, p - a), area = dot(normal, normal);
    if (area > 0 && va > 0 && vb > 0 && vc > 0) return std::sqrt(static_cast<long double>(height * height / area));
    return std::sqrt(
        static_cast<long double>(std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                                           squared_distance_to_segment(p, c, a)})));
}

// Returns the sum of the solid angles of all triangles (van Oosterom and Strackee 1983) over 4 pi: the winding number
// of closed surfaces.
inline double solid_winding(const dvec3& point, std::span<const PlacedTriangle> triangles) {
    double sum = 0;
    for (const PlacedTriangle& each : triangles) {
        const dvec3 a = each.vertices.a - point, b = each.vertices.b - point, c = each.vertices.c - point;
        const double la = length(a), lb = length(b), lc = length(c);
        const double angle =
            2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
        sum += each.is_mirrored ? -angle : angle;
    }
    return sum / (4 * std::numbers::pi);
}

}  // namespace twinray::test
