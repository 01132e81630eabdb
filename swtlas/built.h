// SPDX-License-Identifier: MIT
// What SwTlas keeps of what it has built.
#pragma once

#include "swtlas/plan.h"
#include "swtlas/sw_backend.h"

namespace twinray {

struct SwBackend::SwBuiltGeometry : BuiltGeometry {
    GeometryLayout layout;
    Buffer buffer;

    SwBuiltGeometry(Context& context, const Geometry& geometry, Layout of_trees)
        : layout(layout_geometry(static_cast<uint>(geometry.primitive_count()), of_trees)),
          buffer(context, {.name = "SwTlas geometry '" + geometry.name + "'",
                           .bytes = layout.bytes,
                           .alignment = cache_line_bytes}) {
        bytes = layout.bytes;
    }
    // Null where there are none.
    Ref<BvhNode> nodes() const { return part<BvhNode>(layout.node_count, layout.nodes); }
    Ref<BvhTriangle> triangles() const { return part<BvhTriangle>(layout.triangle_count, layout.triangles); }
    Ref<CompressedRecord> records() const { return part<CompressedRecord>(layout.record_count, layout.records); }

  private:
    template <class T>
    Ref<T> part(uint count, std::uint64_t offset) const {
        return count ? buffer.ref<T>(offset) : Ref<T>{};
    }
};

}  // namespace twinray
