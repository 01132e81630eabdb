// SPDX-License-Identifier: MIT
#include "hwtlas/blas_input.h"

#include <algorithm>

#include "engine/core/ray.h"
#include "hwtlas/order.h"

namespace twinray {

BlasInput blas_input(const Geometry& geometry, bool reorder) {
    const std::vector<vec3> centers = triangle_centers(geometry.positions, geometry.triangles);
    const auto is_active = [&](vec3 center) { return is_finite(center); };
    const auto first_active = std::find_if(centers.begin(), centers.end(), is_active);
    if (first_active == centers.end()) return {};
    const uint anchor = geometry.triangles[static_cast<std::size_t>(first_active - centers.begin())].x;

    BlasInput input;
    input.positions = geometry.positions;
    for (vec3& position : input.positions)
        if (!is_finite(position)) position = geometry.positions[anchor];
    if (reorder) input.original = morton_order(centers);
    input.triangles.reserve(geometry.triangles.size());
    for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
        const std::size_t source = reorder ? input.original[i] : i;
        input.triangles.push_back(is_active(centers[source]) ? geometry.triangles[source] : uvec3(anchor));
    }
    return input;
}

}  // namespace twinray
