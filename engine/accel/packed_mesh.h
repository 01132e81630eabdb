// SPDX-License-Identifier: MIT
// A mesh on the device, as builds read it.
#pragma once

#include "twinray/glsl/cpp.h"

namespace twinray {

// A mesh in device memory: 3 floats a vertex, 3 indices a triangle. Null: it is on the host alone.
struct PackedMesh {
    Floats positions;
    Uints indices;
};

}  // namespace twinray
