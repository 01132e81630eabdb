// SPDX-License-Identifier: MIT
// Decides whether float64 is enough.
#pragma once

#include "engine/core/ray.h"
#include "validation/reference/reference_scene.h"

namespace twinray {

// Returns whether `closest`, the reference's closest hit of the ray, names for certain the triangle that exact
// arithmetic names, or a miss where that misses: no triangle's outline, no other triangle's t and no end of the
// interval is nearer to the decision than the rounding of float64 (see ErrorBounds).
bool is_certain(const ReferenceScene& reference, const Ray& ray, const ReferenceHit& closest);

}  // namespace twinray
