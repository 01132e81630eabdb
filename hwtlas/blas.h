// SPDX-License-Identifier: MIT
#pragma once

#include "engine/accel/geometry.h"
#include "hwtlas/acceleration_structure.h"

namespace twinray {

// The built form of one mesh. Empty, with reference 0, when the mesh has nothing that could be hit: Vulkan takes an
// instance of reference 0 as inactive.
struct Blas {
    AccelerationStructure structure;
    Buffer original_triangles;  // uint each; empty when the order was kept

    std::uint64_t reference() const { return structure.address(); }
    std::uint64_t bytes() const { return structure.bytes() + original_triangles.bytes(); }
};

// Records upload and build of all of them, in order. reorder: presort for drivers that build in input order.
std::vector<Blas> build_blases(Commands& commands, std::span<const Geometry* const> geometries, bool reorder);

}  // namespace twinray
