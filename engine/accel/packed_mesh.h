// SPDX-License-Identifier: MIT
// A mesh on the device, as builds read it.
#pragma once

#include "twinray/glsl/cpp.h"

namespace twinray {

// A mesh in device memory: 3 floats per vertex, 3 indices per triangle. Null: it is only on the host.
struct PackedMesh {
    Floats positions;
    Uints indices;
};

}  // namespace twinray
