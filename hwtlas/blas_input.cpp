// SPDX-License-Identifier: MIT
#include "hwtlas/blas_input.h"

#include <algorithm>

#include "engine/accel/morton_order.h"
#include "engine/core/triangle.h"

namespace twinray {
namespace {

BlasInput boxes_input(std::span<const Bounds> boxes, bool reorder) {
    BlasInput input;
    std::vector<vec3> centers;
    for (const Bounds& box : boxes) {
        centers.push_back(box.center());
        input.bounds.include(box);
    }
    if (reorder) input.original = morton_order(centers);
    for (std::size_t i = 0; i < boxes.size(); ++i) input.boxes.push_back(boxes[reorder ? input.original[i] : i]);
    return input;
}

}  // namespace

BlasInput blas_input(const Geometry& geometry, bool reorder) {
    if (geometry.kind == GEOMETRY_BOXES) return boxes_input(geometry.boxes, reorder);
    const auto is_active = [&](uvec3 vertices) {
        return is_active_triangle(geometry.positions[vertices.x], geometry.positions[vertices.y],
                                  geometry.positions[vertices.z]);
    };
    const auto first_active = std::find_if(geometry.triangles.begin(), geometry.triangles.end(), is_active);
    if (first_active == geometry.triangles.end()) return {};
    const uint anchor = first_active->x;

    BlasInput input;
    input.positions = geometry.positions;
    for (vec3& position : input.positions)
        if (!is_finite(position)) position = geometry.positions[anchor];
    if (reorder) input.original = morton_order(triangle_centers(geometry.positions, geometry.triangles));
    input.triangles.reserve(geometry.triangles.size());
    for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
        const uvec3 vertices = geometry.triangles[reorder ? input.original[i] : i];
        const bool active = is_active(vertices);
        input.triangles.push_back(active ? vertices : uvec3(anchor));
        if (!active) continue;
        for (int vertex = 0; vertex < 3; ++vertex) input.bounds.include(geometry.positions[vertices[vertex]]);
    }
    return input;
}

}  // namespace twinray
