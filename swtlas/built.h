// SPDX-License-Identifier: MIT
// What SwTlas keeps of what it has built.
#pragma once

#include "swtlas/plan.h"
#include "swtlas/sw_tlas.h"

namespace twinray {

struct SwTlas::SwBuiltGeometry : BuiltGeometry {
    GeometryLayout layout;
    Buffer buffer;

    SwBuiltGeometry(Context& context, const Geometry& geometry)
        : layout(layout_geometry(static_cast<uint>(geometry.primitive_count()))),
          buffer(context, {.name = "SwTlas geometry '" + geometry.name + "'", .bytes = layout.bytes}) {
        bytes = layout.bytes;
    }
    Ref<BvhNode> nodes() const { return buffer.ref<BvhNode>(layout.nodes); }
    Ref<BvhTriangle> triangles() const { return buffer.ref<BvhTriangle>(layout.triangles); }
};

}  // namespace twinray
