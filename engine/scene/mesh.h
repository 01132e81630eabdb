// Checks of meshes for importers and accelerators.
#pragma once

#include <twinray/geometry.h>

#include "twinray/glsl/cpp.h"

namespace twinray {

// Calls visit() with the same array of each mesh, for each array that has a value a vertex.
template <class Visit, class... Meshes>
void for_each_vertex_array(const Visit& visit, Meshes&... meshes) {
    visit(meshes.positions...);
    visit(meshes.normals...);
    visit(meshes.tangents...);
    visit(meshes.uvs...);
    visit(meshes.second_uvs...);
    visit(meshes.colors...);
}

// Returns a normal from a file, or 0, which means none, if one of its components is NaN or infinite.
vec3 normal_or_none(const dvec3& normal);

// Counts triangles with a NaN or infinite coordinate; accelerators treat them as inactive.
std::size_t count_non_finite_triangles(const MeshView& mesh);

// Scales to length 1; returns 0 if it has no direction: it is 0, or an entry is NaN or infinite.
dvec3 unit_or_zero(dvec3 v);

// Counts normals without a direction.
std::size_t count_undirected_normals(const Mesh& mesh);

}  // namespace twinray
