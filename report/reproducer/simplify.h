// A ray and the triangles about it, made as small as possible: few triangles, no transforms, short numbers. Pure
// functions of a test.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include <twinray/scene.h>

#include "engine/core/ray.h"

namespace twinray::reproducer {

struct CaseTriangle {
    std::size_t instance = 0;  // index into FaultCase::transforms
    std::array<vec3, 3> vertices;

    bool operator==(const CaseTriangle&) const = default;
};

// Triangles are numbered within their instance in the order of this list; instances without triangles have no number.
struct FaultCase {
    std::vector<Transform> transforms;
    std::vector<CaseTriangle> triangles;
    Ray ray{};
};

// Returns whether a case still shows its fault.
using CaseTest = std::function<bool(const FaultCase&)>;

// Returns the scene's triangles, instance by instance. `reorders`: along a Morton curve, as HwTlas gives them to
// drivers that build in the order of their input. Triangles with a vertex that is not finite are left out, because
// HwTlas never gives them to drivers.
FaultCase case_of(const Scene& scene, const Ray& ray, bool reorders);

// Returns the triangles whose boxes, grown by a quarter, the ray meets, whatever its t_min and t_max, and the one
// numbered `also` of `instance`, if it exists.
FaultCase near_the_ray(const FaultCase& fault, std::size_t instance, std::size_t also);

// Returns the input of the driver: HwTlas builds each mesh in units of a power of two near its largest coordinate,
// which its instances then have in their transforms. Meshes with their largest coordinate in [1, 2) stay as they are.
FaultCase as_built(const FaultCase& fault);

// Makes a mesh for each instance that has triangles; vertices with the same bits are one.
Scene scene_of(const FaultCase& fault);

// Removes instances, then triangles (see ddmin), moves triangles to their place in the world, joins vertices, for
// example around a vertex with many triangles until it has four or three, and gives numbers of few digits to
// coordinates and ray. Takes each step only if the fault stays. `shows_fault` holds for `fault`, and for the result.
FaultCase simplified(FaultCase fault, const CaseTest& shows_fault);

// Two of its steps; each returns whether it changed something.
bool leave_out_triangles(FaultCase& fault, const CaseTest& shows_fault);
bool join_vertices(FaultCase& fault, const CaseTest& shows_fault);

// Delta debugging: the least part of an input that still shows a fault.
using Indices = std::vector<std::size_t>;  // ascending
using ShowsFault = std::function<bool(const Indices& kept)>;

// Runs the algorithm ddmin of Zeller and Hildebrandt 2002 ("Simplifying and Isolating Failure-Inducing Input", IEEE
// Transactions on Software Engineering 28(2)) over the indices 0 to count - 1. All of them together show the fault. No
// index can be left out of the result without losing it (1-minimal), if shows_fault() always answers a question alike.
// Asks at most count^2 + 3 count questions, or 2 log2(count) if one index is enough.
Indices ddmin(std::size_t count, const ShowsFault& shows_fault);

// Floats that are easier to read than a given one, and near to it.

// Returns the length of a number in base 2: 0 for 0, little for 1, 2, 4, 1/2, ..., more for more significant bits, for
// a minus sign, and for exponents far from 0. Infinity, which means no end, is as short as 0.
int length_of(float value);

// Returns numbers that are shorter than `value`, the shortest first: 0, the nearest powers of two, the nearest number
// of each fewer significant bits and the nearest multiple of each fraction down to 1/16.
std::vector<float> shorter_numbers(float value);

}  // namespace twinray::reproducer
