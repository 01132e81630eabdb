// SPDX-License-Identifier: MIT
#include <twinray/abstract_accel.h>

#include "engine/accel/held_geometry.h"
#include "engine/accel/refinement.h"
#include "engine/accel/world_bound.h"

namespace twinray {

MemoryUsage AccelBackend::memory_usage() const {
    MemoryUsage usage;
    if (scene_) usage.scene = scene_->bytes;
    if (scene_) usage.scratch = scene_->scratch_bytes;
    usage.instances = instances_.buffer().bytes() + (refinement_ ? refinement_->bytes() : 0);
    if (surfaces_) usage.surfaces = surfaces_->bytes();
    for (const HeldGeometry* held : held_geometries()) {
        usage.blocks += held->block.bytes();
        usage.vertices += held->stored.bytes();
        usage.surfaces += held->surface.data.bytes();
        if (held->built) usage.geometries += held->built->bytes;
        usage.host += held->geometry.host_bytes() + held->surface.packed.capacity();
    }
    for (const auto& [id, pushed] : pushed_) usage.host += pushed.instances.records.capacity() * sizeof(InstanceRecord);
    return usage;
}

BuildBytes AccelBackend::bytes_of(std::span<const Geometry* const> geometries) const {
    std::vector<GeometrySize> sizes;
    for (const Geometry* geometry : geometries)
        sizes.push_back({geometry->vertex_count(), geometry->primitive_count(), geometry->device.has_value()});
    return geometry_bytes(sizes);
}

BuildBytes AccelBackend::memory_requirements() const {
    std::vector<const Geometry*> unbuilt;
    for (const HeldGeometry* held : held_geometries())
        if (!held->built) unbuilt.push_back(&held->geometry);
    BuildBytes bytes = bytes_of(unbuilt);
    if (dirty_ == Dirty::no) return bytes;
    const std::size_t count = n_instances(), room = scene_ ? scene_->capacity : 0;
    const std::size_t capacity = capacity_for(count, room);
    const BuildBytes scene = scene_bytes(count, capacity);
    if (capacity != room || !scene_) bytes.structures += scene.structures;
    bytes.scratch += scene.scratch;
    return bytes;
}

BuildBytes AccelBackend::memory_requirements(std::span<const GeometrySize> geometries,
                                             std::size_t instance_count) const {
    const BuildBytes bottom = geometry_bytes(geometries);
    const BuildBytes top = scene_bytes(instance_count, capacity_for(instance_count, 0));
    return {bottom.structures + top.structures, bottom.scratch + top.scratch};
}

}  // namespace twinray
