// SPDX-License-Identifier: MIT
// What SwTlas keeps of what it has built.
#pragma once

#include "swtlas/plan.h"
#include "swtlas/sw_tlas.h"

namespace twinray {

struct SwTlas::SwBuiltGeometry : BuiltGeometry {
    GeometryLayout layout;
    Buffer buffer;

    SwBuiltGeometry(Context& context, const Geometry& geometry, Layout of_trees)
        : layout(layout_geometry(static_cast<uint>(geometry.primitive_count()), of_trees)),
          buffer(context, {.name = "SwTlas geometry '" + geometry.name + "'", .bytes = layout.bytes}) {
        bytes = layout.bytes;
    }
    Ref<BvhNode> nodes() const { return buffer.ref<BvhNode>(layout.nodes); }
    Ref<BvhTriangle> triangles() const { return buffer.ref<BvhTriangle>(layout.triangles); }
    // Null where the layout has none.
    Ref<CompressedRecord> records() const {
        return layout.records < layout.bytes ? buffer.ref<CompressedRecord>(layout.records) : Ref<CompressedRecord>{};
    }
};

}  // namespace twinray
