// SPDX-License-Identifier: MIT
#pragma once

#include "engine/accel/geometry.h"
#include "hwtlas/acceleration_structure.h"
#include "hwtlas/hw_scene.h"

namespace twinray {

// The built form of one mesh. Without a structure when the mesh has nothing that could be hit: Vulkan takes an instance
// of address 0 as inactive.
struct Blas {
    Bounds bounds;  // of the active triangles; empty where the device alone knows them
    AccelerationStructure structure;
    Buffer original_triangles;  // uint each; empty when the order was kept
    bool can_update = false;    // made by MovingBlasBuilder

    HwGeometry block() const { return {bounds.lo, bounds.hi, structure.address(), original_triangles.ref<uint>()}; }
    std::uint64_t bytes() const { return structure.bytes() + original_triangles.bytes(); }
};

// A build of triangles from a device address; with uint indices unless the caller changes that.
StructureBuild triangle_build(const std::string& name, std::uint64_t positions, uint vertex_count, uint triangle_count);

// Records upload and build of all of them, in order. reorder: presort for drivers that build in input order.
std::vector<Blas> build_blases(Commands& commands, std::span<const Geometry* const> geometries, bool reorder);

}  // namespace twinray
