// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "engine/accel/geometry.h"
#include "hwtlas/compaction.h"
#include "hwtlas/hw_scene.h"

namespace twinray {

// The built form of one mesh. Without a structure when the mesh has nothing that could be hit: Vulkan takes an instance
// of address 0 as inactive.
struct Blas {
    Bounds bounds;  // of the active triangles; empty where the device alone knows them
    AccelerationStructure structure;
    std::shared_ptr<const Buffer> original_triangles;  // uint each; null when the order was kept
    bool can_update = false;                           // made by MovingBlasBuilder; others may be compacted, once
    std::shared_ptr<CompactedSizes> compacted;         // null: cannot be compacted
    std::size_t place = 0;                             // in `compacted`

    Uints table() const { return original_triangles ? original_triangles->ref<uint>() : Uints{}; }
    HwGeometry block() const { return {bounds.lo, bounds.hi, structure.address(), table()}; }
    std::uint64_t bytes() const { return structure.bytes() + (original_triangles ? original_triangles->bytes() : 0); }
};

// A build of triangles from a device address; with uint indices unless the caller changes that.
StructureBuild triangle_build(const std::string& name, std::uint64_t positions, uint vertex_count, uint triangle_count);

struct BlasOptions {
    bool reorder;                  // presort for drivers that build in input order
    std::uint64_t scratch_budget;  // bytes
};
// Records upload and build of all of them, in order.
std::vector<Blas> build_blases(Commands& commands, std::span<const Geometry* const> geometries,
                               const BlasOptions& options);

}  // namespace twinray
