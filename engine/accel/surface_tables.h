// SPDX-License-Identifier: MIT
// What AccelOptions::keeps_surfaces keeps on the device: arrays of meshes, and the table that leads from a hit to them.
#pragma once

#include <unordered_map>

#include "engine/accel/surface_slice.h"
#include "engine/core/kernel.h"
#include "twinray/glsl/cpp_spawn.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/accel_header.h"
#include "shaders/shared/copies.h"
#include "shaders/shared/intersect.h"
#include "twinray/glsl/surface_at.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(SurfaceAttribute) == 16 && sizeof(SurfaceGeometry) == 32 && sizeof(SurfaceTable) == 40);

class SurfaceTables {
  public:
    explicit SurfaceTables(Context& context);

    AttributeNames& names() { return names_; }

    struct Item {
        std::uint64_t handle = 0;
        std::size_t faces = 0, instances = 0;
        SurfaceSlice* slice = nullptr;
    };
    // What stage() recorded, to be committed once it is certain to run.
    struct Staged {
        std::unordered_map<SurfaceSlice*, Buffer> data;
        std::optional<Buffer> rows;
    };
    // Records the upload of arrays that are not on the device yet, and of the table of all items, in the order of their
    // instances.
    Staged stage(Commands& commands, std::span<const Item> items, Ref<InstanceRecord> instances) const;
    void commit(Staged&& staged);

    // Waits. Words of a slice that is on the device.
    std::vector<uint> read(const SurfaceSlice& slice, const SurfaceSlice::Place& place, std::size_t count) const;

    Ref<SurfaceTable> table() const { return table_.ref<SurfaceTable>(); }
    std::uint64_t bytes() const { return table_.bytes() + rows_.bytes(); }

  private:
    std::uint64_t stage_data(Commands& commands, SurfaceSlice& slice, Staged& staged) const;

    Context& context_;
    Kernel<CopyWordsArgs> copy_words_;
    AttributeNames names_;
    Buffer table_, rows_;
};

}  // namespace twinray
