// SPDX-License-Identifier: MIT
#pragma once

#include "engine/accel/instance_record.h"
#include "hwtlas/acceleration_structure.h"
#include "hwtlas/hw_scene.h"

namespace twinray {

struct TlasInstance {
    InstanceRecord record;
    vec3 center_world;         // of its box; read only when reordering
    Uints original_triangles;  // of its Blas; read only when reordering
};

// The top level on the device.
struct Tlas {
    AccelerationStructure structure;
    Buffer instances;  // HwInstance each; empty when the order was kept
    Buffer scene;      // one HwScene

    std::uint64_t bytes() const { return structure.bytes() + instances.bytes() + scene.bytes(); }
};

// Records upload and build. No instances at all is allowed: every ray misses.
Tlas build_tlas(Commands& commands, std::span<const TlasInstance> instances, bool reorder);

}  // namespace twinray
