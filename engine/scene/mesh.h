// SPDX-License-Identifier: MIT
// What importers and accelerators check of meshes.
#pragma once

#include <twinray/geometry.h>

#include "twinray/glsl/cpp.h"

namespace twinray {

// A normal from a file, or 0, that is none, where one of its components is no number or infinite.
vec3 normal_or_none(const dvec3& normal);

// Triangles with a NaN or infinite coordinate; accelerators treat them as inactive.
std::size_t count_non_finite_triangles(const MeshView& mesh);

// Of length 1; 0 where it has no direction: it is 0, or an entry is NaN or infinite.
dvec3 unit_or_zero(dvec3 v);

// Normals without a direction.
std::size_t count_undirected_normals(const Mesh& mesh);

}  // namespace twinray
