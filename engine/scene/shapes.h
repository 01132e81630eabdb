// SPDX-License-Identifier: MIT
// Meshes made by formula, for tests, samples and benchmarks. The same arguments give the same bits
// everywhere.
#pragma once

#include "engine/scene/mesh.h"

namespace twinray {

// Two triangles spanning corner, corner + u, corner + u + v, corner + v; the normal points along cross(u, v).
Mesh make_quad(vec3 corner, vec3 u, vec3 v);

// Twelve triangles facing outwards, four vertices a face, so that normals are flat.
Mesh make_box(vec3 lo, vec3 hi);

// A sphere about the origin of 20 * 4^subdivisions triangles facing outwards, with smooth normals. Closed: vertices
// are shared. Throws Error above 12 subdivisions.
Mesh make_icosphere(uint subdivisions, float radius = 1);

// A height field of 2 nx ny triangles over [0, 1]^2 in x and z, facing +y, with uvs. `height` is the amplitude of
// random heights, 0 = flat. Throws Error when nx or ny is 0 or the vertices do not fit into 32 bits.
Mesh make_grid(uint nx, uint ny, float height = 0, uint seed = 0);

// Separate random triangles with corners at most `size` from centres in [0, 1]^3.
Mesh make_soup(uint triangle_count, uint seed, float size = 0.1f);

}  // namespace twinray
