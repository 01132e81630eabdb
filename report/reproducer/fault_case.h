// SPDX-License-Identifier: MIT
// A ray and the triangles about it, in a form from which triangles are easily left out.
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

}  // namespace twinray::reproducer
