// SPDX-License-Identifier: MIT
#include "engine/accel/geometry.h"

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

}  // namespace

Geometry::Geometry(const MeshView& mesh)
    : name(mesh.name),
      positions(mesh.positions.begin(), mesh.positions.end()),
      triangles(mesh.triangles.begin(), mesh.triangles.end()),
      non_finite_triangles(checked_count(mesh)) {}

InstanceRecord make_instance_record(const Transform& transform, uint custom_index, std::uint8_t mask) {
    InstanceRecord record{};
    for (int row = 0; row < 3; ++row) record.object_to_world[row] = transform.rows[static_cast<std::size_t>(row)];
    record.custom_index_mask = custom_index | (uint{mask} << 24);
    return record;
}

Transform transform_of(const InstanceRecord& record) {
    return {{record.object_to_world[0], record.object_to_world[1], record.object_to_world[2]}};
}

}  // namespace twinray
