// SPDX-License-Identifier: MIT
// What AccelOptions::keeps_surfaces keeps on the device: arrays of meshes, and the table that leads from a hit to them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <twinray/geometry.h>

#include "engine/core/commands.h"
#include "twinray/glsl/cpp_spawn.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/accel_header.h"
#include "shaders/shared/intersect.h"
#include "twinray/glsl/surface_at.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(SurfaceAttribute) == 16 && sizeof(SurfaceGeometry) == 32 && sizeof(SurfaceTable) == 40);

// The arrays of one geometry, in one buffer.
struct SurfaceSlice {
    struct Array {
        uint number = 0, components = 0;
        bool is_per_face = false;
        std::uint64_t offset = 0;
    };
    std::vector<Array> arrays;
    std::optional<std::uint64_t> face_metadata, metadata;  // where they lie
    std::vector<std::byte> packed;                         // until it is on the device
    Buffer data;

    std::uint64_t bytes() const { return data.bytes(); }
};

class SurfaceTables {
  public:
    explicit SurfaceTables(Context& context);

    // Copies what the mesh has. Throws Error naming the mesh and the array whose length does not fit, or whose name is
    // empty, taken or one too many.
    SurfaceSlice slice_of(const MeshView& mesh);
    // By its name, "normals", "tangents", "uv0", "uv1", "colors" or one of MeshView::attributes; none: no mesh had it.
    std::optional<uint> number_of(std::string_view name) const;

    struct Item {
        std::uint64_t handle = 0;
        std::size_t faces = 0, instances = 0;
        SurfaceSlice* slice = nullptr;
    };
    // What stage() recorded, to be committed once it is certain to run.
    struct Staged {
        std::vector<std::pair<SurfaceSlice*, Buffer>> data;
        std::optional<Buffer> rows;
    };
    // Records the upload of arrays that are not on the device yet, and of the table of all items, in the order of their
    // instances.
    Staged stage(Commands& commands, std::span<const Item> items, Ref<InstanceRecord> instances) const;
    void commit(Staged&& staged);

    Ref<SurfaceTable> table() const { return table_.ref<SurfaceTable>(); }
    std::uint64_t bytes() const { return table_.bytes() + rows_.bytes(); }

  private:
    Context& context_;
    std::vector<std::string> names_;
    Buffer table_, rows_;
};

}  // namespace twinray
