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

InstanceRecord make_instance_record(const Transform& transform, const InstanceOptions& options) {
    InstanceRecord record{};
    for (int row = 0; row < 3; ++row) record.object_to_world[row] = transform.rows[static_cast<std::size_t>(row)];
    record.custom_index_mask = options.custom_index | (uint{options.mask} << 24);
    record.sbt_offset_flags =
        (options.no_culling ? INSTANCE_NO_CULLING << 24 : 0) | (options.turned ? INSTANCE_TURNED << 24 : 0);
    return record;
}

InstanceOptions options_of(const InstanceRecord& record) {
    return {.custom_index = custom_index_of(record),
            .mask = static_cast<std::uint8_t>(mask_of(record)),
            .no_culling = (flags_of(record) & INSTANCE_NO_CULLING) != 0,
            .turned = (flags_of(record) & INSTANCE_TURNED) != 0};
}

Transform transform_of(const InstanceRecord& record) {
    return {{record.object_to_world[0], record.object_to_world[1], record.object_to_world[2]}};
}

}  // namespace twinray
