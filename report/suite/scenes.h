// The parts from which cases make their scenes and rays.
#pragma once

#include <random>

#include <twinray/geometry.h>
#include <twinray/scene.h>
#include "report/suite/case_run.h"
#include "validation/reference/aimed_rays.h"

namespace twinray::suite {

inline constexpr float inf = std::numeric_limits<float>::infinity();
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A random generator: one seed gives the same numbers on every platform.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(static_cast<std::uint32_t>(seed)) {}
    float between(float low, float high) { return low + (high - low) * static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    vec3 in_box(float extent);
    vec3 direction();      // uniform on the unit sphere
    Transform rotation();  // uniform
    vec2 in_triangle();    // (u, v), uniform
    uint below(std::size_t count) { return static_cast<uint>(engine_()) % static_cast<uint>(count); }
    // Returns positive weights of three vertices, which sum to 1 and are at least `least`.
    dvec3 weights(double least);

  private:
    std::mt19937 engine_;
};

// Both leave the mesh without normals and texture coordinates.
void add_triangle(Mesh& mesh, vec3 a, vec3 b, vec3 c);
void append(Mesh& mesh, const Mesh& part);
Mesh scaled(Mesh mesh, float factor);
Mesh moved(Mesh mesh, vec3 offset);
std::array<dvec3, 3> corners_of(const Mesh& mesh, const uvec3& triangle);
// Returns the point with these weights of the triangle of three vertices from `first` on.
dvec3 point_in(const Mesh& mesh, uint first, const dvec3& weights);
// Makes an instance of the mesh for each transform.
Scene instances_of(const Mesh& mesh, const std::vector<Transform>& transforms = {Transform{}});
// Turns axes: x becomes y, y becomes z, z becomes x, `times` times.
vec3 turned(vec3 v, int times);
// Return the linear part of a transform and, for normals, its inverse transposed, in float64.
glm::dmat3 linear_of(const Transform& transform);
glm::dmat3 normals_of(const Transform& transform);
// Moves the origins only; t changes by the factor.
std::vector<Ray> scaled(std::span<const Ray> rays, float factor);

// Returns the closest hits of rays at this power of two, with t of the unit scale: `fill` pushes the scene at a scale.
std::vector<Hit> hits_at_scale(CaseRun& run, const Configuration& configuration, std::span<const Ray> rays,
                               int exponent, const std::function<void(AbstractAccel&, float scale)>& fill);

// Axes scaled within 10^most and 10^-most, then turned. The ray follows the axis that is scaled least. In object space
// it begins 3 before the middle and covers 1 per unit of t, so that rounding moves it by little there.
struct ScaledPlace {
    Transform transform;
    Ray ray;
};
ScaledPlace scaled_place(Random& random, float most);

// Returns a ray from an origin, which is rounded first, to the target, which it passes within float32 rounding.
// |direction| = 1.
Ray ray_to(const dvec3& target, const dvec3& origin);
// Spreads `random` of them over the bounds, and aims `aimed` at vertices and as many at edges.
std::vector<Ray> random_and_aimed(const ReferenceScene& reference, const Bounds& bounds, std::size_t random,
                                  std::size_t aimed, std::uint64_t seed);
// Spreads half of them over the bounds, and aims a quarter each at vertices and at edges.
std::vector<Ray> mixed_rays(const World& world, const Bounds& bounds, std::size_t count, std::uint64_t seed);

// ---- Meshes of cases with known view factors.

// Makes one instance of each mesh; only the second is moved.
Scene scene_of(std::vector<Mesh> meshes, vec3 second_at = vec3(0));
Mesh seen_from_inside(Mesh mesh);

// Returns a square at the height z over [0, side]^2, of n x n cells of two triangles each, that faces up or down.
Mesh square(float z, bool looks_up, uint n = 1, float side = 1);
// Returns squares that face each other.
Scene parallel_squares(float distance, uint n = 1, float side = 1);
// ---- Meshes of the cases of section W, and rays at their edges.

// Returns make_grid in units of its cells: n x n of them in the plane y = 0, corners at integers.
Mesh make_integer_grid(uint n);

// Returns the closed surface of a box, cut along ascending planes x, y and z = const; vertices are shared.
Mesh make_cut_box(const std::array<std::vector<float>, 3>& planes);

// Returns a ray without an end.
Ray make_ray(const vec3& origin, const vec3& direction);

// Returns rays through corners of the grid's cells, points of cell edges and of their diagonals, in turns, from both
// sides. Every coordinate is a multiple of 1/8 below 128, so that the ray passes its target exactly, at t = 1, and no
// arithmetic rounds. Slanted rays come from up to 8 cells beside; the others go straight up or down, with x and z of
// the direction at 0.
std::vector<Ray> exact_grid_rays(uint n, bool slanted, std::size_t count, std::uint64_t seed);

}  // namespace twinray::suite
