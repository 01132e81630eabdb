// Rational arithmetic, in which sums, products and quotients of floats are exact: a line against a triangle, and the
// closest hit of a scene, the last word where float64 cannot tell.
#pragma once

#include <gmpxx.h>

#include <optional>
#include <vector>

#include "validation/reference/reference_scene.h"

namespace twinray::exact {

using Rational = mpq_class;

// A vector of rational numbers.
struct Vector {
    Rational x, y, z;

    const Rational& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

// Takes finite numbers.
inline Vector vector_of(const dvec3& v) { return {v.x, v.y, v.z}; }

inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Rational dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Returns the nearest double; ties go to the even one.
double rounded(const Rational& value);

// The points origin + t direction.
struct Line {
    Vector origin, direction;
};

// The part of a closed triangle that a line meets: its inside, an edge but no vertex, or a vertex.
enum class Incidence : std::uint8_t { interior, edge, vertex };

struct Crossing {
    Rational t;     // in units of the line's direction
    Rational u, v;  // the point is (1-u-v) v0 + u v1 + v v2
    Incidence incidence = Incidence::interior;
    bool along = false;  // the normal (v1 - v0) x (v2 - v0) points along the line
};

// Returns six times the signed volumes of (direction, b, c), (direction, c, a) and (direction, a, b), vertices a, b, c
// seen from the origin: the weights of the vertices, times a common factor. The line meets the triangle where they have
// one sign; one that is 0 puts the line on the edge across from its vertex; all 0: the plane contains the line.
std::array<Rational, 3> edge_values(const Line& line, const Triangle64& triangle);

// Returns nothing if the line passes the triangle or lies in its plane. t may be negative.
std::optional<Crossing> crossing(const Line& line, const Triangle64& triangle);

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
