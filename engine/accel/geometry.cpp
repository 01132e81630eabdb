#include "engine/accel/geometry.h"

#include <algorithm>
#include <cmath>

#include "engine/accel/mesh_gather.h"
#include "engine/core/error.h"
#include "engine/scene/mesh.h"

namespace twinray {
namespace {

void check_count(std::string_view name, std::size_t count, const char* what) {
    if (count > Geometry::max_primitives)
        fail("mesh '", name, "': ", count, " ", what, "; at most ", Geometry::max_primitives, " fit in one geometry");
}

std::string coordinates_of(vec3 v) { return text(v.x, ", ", v.y, ", ", v.z); }

SharedArray<uvec3> checked(const MeshView& mesh) {
    check_count(mesh.name, mesh.triangles.size(), "triangles");
    check_indices(mesh);
    if (mesh.shared) return mesh.shared->triangles;
    return std::vector<uvec3>(mesh.triangles.begin(), mesh.triangles.end());
}

std::span<const Bounds> checked(const BoxesView& view) {
    check_count(view.name, view.boxes.size(), "boxes");
    for (std::size_t i = 0; i < view.boxes.size(); ++i)
        if (const Bounds& box = view.boxes[i]; box.is_empty() || !is_finite(box.lo) || !is_finite(box.hi))
            fail("boxes '", view.name, "': box ", i, " from (", coordinates_of(box.lo), ") to (",
                 coordinates_of(box.hi), ") must be finite and not empty");
    return view.boxes;
}

}  // namespace

SharedArray<vec3> times(const SharedArray<vec3>& positions, float factor) {
    if (factor == 1) return positions;
    std::vector<vec3> scaled(positions.begin(), positions.end());
    for (vec3& p : scaled) p *= factor;
    return scaled;
}

Geometry::Geometry(const MeshView& mesh, float unit)
    : name(mesh.name), scale(unit), triangles(checked(mesh)), non_finite_triangles(count_non_finite_triangles(mesh)) {
    positions = mesh.shared ? mesh.shared->positions : std::vector<vec3>(mesh.positions.begin(), mesh.positions.end());
}

Geometry::Geometry(const DeviceMesh& mesh, float unit) : name(mesh.name), scale(unit) {
    if (mesh.triangle_count == 0) return;
    check_device_mesh(mesh);
    device = mesh;
    device->name = {};
    device->attributes = {};
    device->metadata = {};
}

void Geometry::forget_mesh(bool is_on_device) {
    if (device || kind == GEOMETRY_BOXES) return;
    forgotten = counts();
    positions = {};
    triangles = {};
    if (!is_on_device) leaves = std::vector<Leaf>();
}

std::uint64_t Geometry::host_bytes() const {
    return std::span(positions).size_bytes() + std::span(triangles).size_bytes() + boxes.capacity() * sizeof(Bounds) +
           leaves.capacity() * sizeof(Leaf) + welded.positions.capacity() * sizeof(vec3) +
           welded.triangles.capacity() * sizeof(uvec3);
}

int Geometry::size_exponent(std::span<const vec3> positions) {
    float largest = 0;
    for (const vec3& p : positions)
        if (is_finite(p)) largest = std::max(largest, largest_entry(p));
    return largest == 0 ? 0 : std::ilogb(largest);
}

float Geometry::near_unit(std::span<const vec3> positions) {
    // The unit and its reciprocal must stay in the range of normal floats.
    return std::ldexp(1.0f, std::clamp(size_exponent(positions), -100, 100));
}

Geometry::Geometry(const BoxesView& view)
    : name(view.name), kind(GEOMETRY_BOXES), boxes(checked(view).begin(), view.boxes.end()) {}

InstanceRecord make_instance_record(const Transform& transform, const InstanceOptions& options) {
    InstanceRecord record{};
    record.object_to_world = {transform.rows[0], transform.rows[1], transform.rows[2]};
    record.custom_index_mask = options.custom_index | (uint{options.mask} << 24);
    record.sbt_offset_flags = (options.disable_culling ? INSTANCE_DISABLE_CULLING << 24 : 0) |
                              (options.flip_facing ? INSTANCE_FLIP_FACING << 24 : 0) |
                              (options.non_opaque ? INSTANCE_NON_OPAQUE << 24 : 0);
    return record;
}

InstanceOptions options_of(const InstanceRecord& record) {
    return {.custom_index = custom_index_of(record),
            .mask = static_cast<std::uint8_t>(mask_of(record)),
            .disable_culling = (flags_of(record) & INSTANCE_DISABLE_CULLING) != 0,
            .flip_facing = (flags_of(record) & INSTANCE_FLIP_FACING) != 0,
            .non_opaque = (flags_of(record) & INSTANCE_NON_OPAQUE) != 0};
}

Transform transform_of(const InstanceRecord& record) {
    const Rows& rows = record.object_to_world;
    return {{rows.r0, rows.r1, rows.r2}};
}

}  // namespace twinray
