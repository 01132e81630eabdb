// SPDX-License-Identifier: MIT
// What SwTlas keeps of what it has built.
#pragma once

#include "swtlas/sw_tlas.h"

namespace twinray {

struct SwTlas::SwBuiltGeometry : BuiltGeometry {
    Buffer buffer;  // see layout_geometry

    SwBuiltGeometry(Context& context, const std::string& mesh, std::uint64_t buffer_bytes)
        : buffer(context, {.name = "SwTlas geometry '" + mesh + "'", .bytes = buffer_bytes}) {
        bytes = buffer_bytes;
    }
};

}  // namespace twinray
