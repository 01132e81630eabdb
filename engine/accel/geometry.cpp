// SPDX-License-Identifier: MIT
#include "engine/accel/geometry.h"

#include "engine/core/error.h"

namespace twinray {
namespace {

void check_count(std::string_view name, std::size_t count, const char* what) {
    if (count > Geometry::max_primitives)
        fail("mesh '", name, "': ", count, " ", what, "; at most ", Geometry::max_primitives, " fit in one geometry");
}

std::string joined(vec3 v) { return text(v.x, ", ", v.y, ", ", v.z); }

std::span<const uvec3> checked(const MeshView& mesh) {
    check_count(mesh.name, mesh.triangles.size(), "triangles");
    check_indices(mesh);
    return mesh.triangles;
}

std::span<const Bounds> checked(const BoxesView& view) {
    check_count(view.name, view.boxes.size(), "boxes");
    for (std::size_t i = 0; i < view.boxes.size(); ++i)
        if (const Bounds& box = view.boxes[i]; box.is_empty() || !is_finite(box.lo) || !is_finite(box.hi))
            fail("boxes '", view.name, "': box ", i, " from (", joined(box.lo), ") to (", joined(box.hi),
                 ") must be finite and not empty");
    return view.boxes;
}

}  // namespace

Geometry::Geometry(const MeshView& mesh)
    : name(mesh.name),
      positions(mesh.positions.begin(), mesh.positions.end()),
      triangles(checked(mesh).begin(), mesh.triangles.end()),
      non_finite_triangles(count_non_finite_triangles(mesh)) {}

Geometry::Geometry(const BoxesView& view)
    : name(view.name), kind(GEOMETRY_BOXES), boxes(checked(view).begin(), view.boxes.end()) {}

InstanceRecord make_instance_record(const Transform& transform, const InstanceOptions& options) {
    InstanceRecord record{};
    for (int row = 0; row < 3; ++row) record.object_to_world[row] = transform.rows[static_cast<std::size_t>(row)];
    record.custom_index_mask = options.custom_index | (uint{options.mask} << 24);
    record.sbt_offset_flags = (options.no_culling ? INSTANCE_NO_CULLING << 24 : 0) |
                              (options.turned ? INSTANCE_TURNED << 24 : 0) |
                              (options.filtered ? INSTANCE_FILTERED << 24 : 0);
    return record;
}

InstanceOptions options_of(const InstanceRecord& record) {
    return {.custom_index = custom_index_of(record),
            .mask = static_cast<std::uint8_t>(mask_of(record)),
            .no_culling = (flags_of(record) & INSTANCE_NO_CULLING) != 0,
            .turned = (flags_of(record) & INSTANCE_TURNED) != 0,
            .filtered = (flags_of(record) & INSTANCE_FILTERED) != 0};
}

Transform transform_of(const InstanceRecord& record) {
    return {{record.object_to_world[0], record.object_to_world[1], record.object_to_world[2]}};
}

}  // namespace twinray
