// The device data of AccelOptions::keeps_surfaces: arrays of meshes, and the table that leads from a hit to them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <twinray/device_mesh.h>

#include "engine/core/kernel.h"
#include "twinray/glsl/cpp_spawn.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/accel_header.h"
#include "shaders/shared/copies.h"
#include "shaders/shared/surface_args.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(SurfaceAttribute) == 16 && sizeof(SurfaceGeometry) == 32 && sizeof(SurfaceTable) == 40);

// The attributes that an accelerator's meshes have, in the order of their numbers: the ATTRIBUTE_* first.
class AttributeNames {
  public:
    // Returns nullopt if no mesh had it.
    std::optional<uint> number_of(std::string_view name) const;
    // Throws Error naming the mesh and the first name beyond the limit.
    uint number_for(std::string_view mesh, std::string_view name);

  private:
    std::vector<std::string> names_{"normals", "tangents", "uv0", "uv1", "colors"};
};

// The arrays of one geometry, in one buffer, or in the caller's memory.
struct SurfaceSlice {
    struct Place {
        std::uint64_t offset = 0;
        std::uint64_t in_place = 0;  // the address instead, unless 0

        std::uint64_t address(std::uint64_t base) const { return in_place ? in_place : base + offset; }
    };
    struct Array {
        uint number = 0, components = 0;
        bool is_per_face = false;
        Place place;
    };
    // Words that are copied from the caller's memory.
    struct Copy {
        Uints from;
        std::uint64_t offset = 0, words = 0;

        std::uint64_t end() const { return offset + words * sizeof(uint); }
    };
    std::vector<Array> arrays;
    std::optional<Place> face_metadata, metadata;
    // Holds the data until it is on the device.
    std::vector<std::byte> packed;  // from 0 on
    std::vector<Copy> copies;       // behind it, in order
    Buffer data;

    bool is_empty() const { return arrays.empty() && !face_metadata && !metadata; }
    std::uint64_t pending_bytes() const { return copies.empty() ? packed.size() : copies.back().end(); }
};

// Appends at a multiple of 16 bytes and returns that position.
std::uint64_t append_aligned(std::vector<std::byte>& packed, std::span<const std::byte> bytes);

// Throws Error naming the mesh and the array whose length, components or address do not fit, or whose name is empty or
// taken; also for arrays that the accelerator does not keep.
void check_arrays(const MeshView& mesh);
void check_arrays(const DeviceMesh& mesh);

// Returns the mesh without the arrays that AccelOptions::keeps_metadata does not keep.
MeshView metadata_of(const MeshView& mesh);
DeviceMesh metadata_of(const DeviceMesh& mesh);

// Copies the checked mesh's arrays, or notes where the device has them. Throws Error naming the mesh and the first
// attribute name beyond the limit; `names` is then unchanged.
SurfaceSlice surface_slice(const MeshView& mesh, AttributeNames& names);
SurfaceSlice surface_slice(const DeviceMesh& mesh, AttributeNames& names);

class SurfaceTables {
  public:
    explicit SurfaceTables(Context& context);

    AttributeNames& names() { return names_; }

    struct Item {
        std::uint64_t handle = 0;
        std::size_t faces = 0, instances = 0;
        SurfaceSlice* slice = nullptr;
    };
    // The result of stage(), to be committed once its commands are certain to run.
    struct Staged {
        std::unordered_map<SurfaceSlice*, Buffer> data;
        std::optional<Buffer> rows;
    };
    // Records the upload of arrays that are not on the device yet, and of the table of all items, in the order of their
    // instances.
    Staged stage(Commands& commands, std::span<const Item> items, Ref<InstanceRecord> instances) const;
    void commit(Staged&& staged);

    // Waits. Returns words of a slice that is on the device.
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

// Kernels that find the surfaces of hits for the host.
struct SurfaceKernels {
    explicit SurfaceKernels(Context& context);

    Kernel<SurfaceArgs> surfaces;
    Kernel<InterpolateArgs> interpolate;
};

}  // namespace twinray
