// SPDX-License-Identifier: MIT
#include "engine/accel/geometry.h"

#include <cmath>

#include "engine/core/error.h"

namespace twinray {
namespace {

std::size_t checked_count(const MeshView& mesh) {
    if (mesh.triangles.size() > Geometry::max_triangles)
        fail("mesh '", mesh.name, "': ", mesh.triangles.size(), " triangles; at most ", Geometry::max_triangles,
             " fit in one geometry");
    check_indices(mesh);
    return count_non_finite_triangles(mesh);
}

float round_down(double x) {
    const float f = static_cast<float>(x);
    return f > x ? std::nextafter(f, -INFINITY) : f;
}

float round_up(double x) {
    const float f = static_cast<float>(x);
    return f < x ? std::nextafter(f, INFINITY) : f;
}

}  // namespace

Geometry::Geometry(const MeshView& mesh)
    : name(mesh.name),
      positions(mesh.positions.begin(), mesh.positions.end()),
      triangles(mesh.triangles.begin(), mesh.triangles.end()),
      non_finite_triangles(checked_count(mesh)) {
    bounds = bounds_of(mesh);
}

InstanceRecord make_instance_record(const Transform& transform, uint custom_index, std::uint8_t mask) {
    InstanceRecord record{};
    for (int row = 0; row < 3; ++row) record.object_to_world[row] = transform.rows[static_cast<std::size_t>(row)];
    record.custom_index_mask = custom_index | (uint{mask} << 24);
    return record;
}

Transform transform_of(const InstanceRecord& record) {
    return {{record.object_to_world[0], record.object_to_world[1], record.object_to_world[2]}};
}

Bounds transformed(const Bounds& bounds, const Transform& transform) {
    if (bounds.is_empty()) return {};
    Bounds result;
    for (int row = 0; row < 3; ++row) {
        const vec4& m = transform.rows[static_cast<std::size_t>(row)];
        double lo = m.w, hi = m.w;
        for (int column = 0; column < 3; ++column) {
            const double a = double{m[column]} * bounds.lo[column], b = double{m[column]} * bounds.hi[column];
            lo += std::min(a, b);
            hi += std::max(a, b);
        }
        result.lo[row] = round_down(lo);
        result.hi[row] = round_up(hi);
    }
    return result;
}

}  // namespace twinray
