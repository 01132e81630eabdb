// SPDX-License-Identifier: MIT
// A closed mesh with relief, of any size: what rates and builds are measured on.
#pragma once

#include "engine/scene/mesh.h"

namespace twinray::bench {

// Edges of the icosahedron are cut into as many: 20 frequency^2 triangles. The nearest to a number of triangles.
uint geodesic_frequency(double triangles);

// A geodesic sphere about the origin, displaced along its radius by five octaves of noise: radii of 0.75 to 1.25.
// Closed: vertices are shared, triangles face outwards. The same bits everywhere. `frequency` is at least 1.
Mesh make_displaced_sphere(uint frequency);

}  // namespace twinray::bench
