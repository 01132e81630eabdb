// SPDX-License-Identifier: MIT
// The structures that SwTlas keeps.
#pragma once

#include "engine/accel/geometry.h"
#include "swtlas/plan.h"
#include "swtlas/sw_backend.h"

namespace twinray {

// The mesh in host memory that a tree is built from.
struct SwBackend::HostMesh {
    std::span<const vec3> positions;
    std::span<const uvec3> triangles;

    explicit HostMesh(const Geometry& geometry) : positions(geometry.positions), triangles(geometry.triangles) {
        if (!geometry.welded.is_empty()) positions = geometry.welded.positions, triangles = geometry.welded.triangles;
    }
};

struct SwBackend::SwBuiltGeometry : BuiltGeometry {
    GeometryLayout layout;
    Buffer buffer;

    // `has_vertices`: of its mesh, in device memory already.
    SwBuiltGeometry(Context& context, const Geometry& geometry, bool has_vertices, Layout of_trees)
        : layout(layout_geometry(leaf_count_of(geometry), vertex_count_of(geometry, has_vertices), of_trees)),
          buffer(context, {.name = "SwTlas geometry '" + geometry.name + "'",
                           .bytes = layout.bytes,
                           .alignment = cache_line_bytes}) {
        bytes = layout.bytes;
    }
    static uint leaf_count_of(const Geometry& geometry) {
        return static_cast<uint>(geometry.leaves.empty() ? geometry.primitive_count() : geometry.leaves.size());
    }
    static std::size_t vertex_count_of(const Geometry& geometry, bool has_vertices) {
        if (geometry.leaves.empty() || has_vertices) return 0;
        return geometry.welded.is_empty() ? geometry.vertex_count() : geometry.welded.positions.size();
    }
    // Returns null if there are none.
    Ref<BvhNode> nodes() const { return part<BvhNode>(layout.node_count, layout.nodes); }
    Ref<BvhTriangle> triangles() const { return part<BvhTriangle>(layout.triangle_count, layout.triangles); }
    Ref<CompressedRecord> records() const { return part<CompressedRecord>(layout.record_count, layout.records); }
    Floats vertices() const { return {part<vec3>(layout.vertex_count, layout.vertices).address}; }

  private:
    template <class T>
    Ref<T> part(std::size_t count, std::uint64_t offset) const {
        return count ? buffer.ref<T>(offset) : Ref<T>{};
    }
};

}  // namespace twinray
