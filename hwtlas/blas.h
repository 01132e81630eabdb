// SPDX-License-Identifier: MIT
#pragma once

#include "engine/accel/geometry.h"
#include "hwtlas/acceleration_structure.h"
#include "hwtlas/hw_scene.h"

namespace twinray {

// The built form of one geometry. Without a structure when it has nothing that could be hit: Vulkan takes an instance
// of address 0 as inactive.
struct Blas {
    uint kind = GEOMETRY_TRIANGLES;
    Bounds bounds;  // of the active primitives
    AccelerationStructure structure;
    Buffer original;  // see BlasInput, uint each; empty when the order was kept

    HwGeometry block() const { return {bounds.lo, bounds.hi, structure.address(), original.ref<uint>(), kind, 0}; }
    std::uint64_t bytes() const { return structure.bytes() + original.bytes(); }
};

// Records upload and build of all of them, in order. reorder: presort for drivers that build in input order.
std::vector<Blas> build_blases(Commands& commands, std::span<const Geometry* const> geometries, bool reorder);

}  // namespace twinray
