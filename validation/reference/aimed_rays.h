// SPDX-License-Identifier: MIT
// Rays for verification and measurement: a camera's, spread over a scene, or aimed where intersection tests break.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/ray.h"
#include "engine/scene/mesh.h"
#include "validation/reference/reference_scene.h"

namespace twinray {

// All generators: ray i depends only on (seed, i) and the scene, never on the platform or on `count`; origins and
// directions are finite, directions have length 1 up to rounding, t_min = 0 and t_max = infinity.

// Even rays start in the box grown by a tenth of its diagonal, odd ones in the box grown by one diagonal;
// directions are uniform on the sphere. An empty box counts as the unit cube around 0.
std::vector<Ray> random_rays(const Bounds& bounds, std::size_t count, std::uint64_t seed);

// Each ray is aimed at a vertex of a random active triangle of a random instance, transformed in float64, from an
// origin 0.05 to 2 scene diagonals away, inside or outside the scene. origin is rounded to float32 first and
// direction = (target - origin) / length last, so the ray passes its target within float32 rounding.
// Without an active triangle these are random_rays of an empty box.
std::vector<Ray> vertex_aimed_rays(const ReferenceScene& scene, std::size_t count, std::uint64_t seed);

// Does the same, aimed at a point (1-w) a + w b of an edge, w uniform in [0, 1).
std::vector<Ray> edge_aimed_rays(const ReferenceScene& scene, std::size_t count, std::uint64_t seed);

// Returns pinhole rays over the scene from a corner above, in tiles of 8 x 8 pixels as a renderer would; `width` pixels
// per side, a multiple of 8.
std::vector<Ray> primary_rays(const Bounds& bounds, uint width);

}  // namespace twinray
