// SPDX-License-Identifier: MIT
// Meshes in device memory: those with moving vertices, and those of callers.
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/accel/geometry.h"
#include "engine/accel/mesh_gather.h"
#include "engine/accel/surface_area.h"
#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/copies.h"
#include "twinray/glsl/cpp_end.h"

// The parts of one geometry's mesh that the device has and lacks. It is empty until a vertex is first moved, unless
// level refined or AccelOptions::keeps_surfaces needs the mesh; from then on everything is built from the device's
// copy. For a DeviceMesh in place it only holds costs: each sync that builds or refits it makes its copy anew.
struct VertexSlice {
    Buffer positions, indices;
    CostLog costs;              // of the geometry's tree
    bool edited = false;        // moved since the last sync, by the host, by `incoming` or in Geometry::device
    bool device_wrote = false;  // positions that Geometry::positions lacks
    bool gathers = false;       // the next sync reads Geometry::device
    bool rebuilds = false;      // it is another mesh of the same size
    Floats incoming;            // device memory in the user's units that the next sync copies the positions from; 0 =
                                // Geometry::positions

    bool on_device() const { return indices.bytes() != 0; }
    std::uint64_t bytes() const { return positions.bytes() + indices.bytes() + costs.bytes(); }
    PackedMesh mesh() const { return {positions.ref<float>(), indices.ref<uint>()}; }
    void read_again() { edited = gathers = device_wrote = true, incoming = {}; }
};

// Brings moved vertices to the device.
class VertexArrays {
  public:
    explicit VertexArrays(Context& context);

    struct Item {
        const Geometry* geometry;  // has triangles
        VertexSlice* slice;        // edited, or not on the device yet
    };
    // The result of stage(), to be committed once its commands are certain to run.
    struct Staged {
        std::vector<Item> items;
        std::vector<VertexSlice> made;  // by item: what its slice lacks
        std::unordered_map<const VertexSlice*, std::size_t> item_of;
        MeshGather::Faults faults;

        PackedMesh mesh(std::size_t item) const {
            return made[item].on_device() ? made[item].mesh() : items[item].slice->mesh();
        }
        // Returns null for a slice that is neither staged nor on the device.
        PackedMesh mesh_of(const VertexSlice& slice) const;
        CostTarget cost_target(std::size_t item) const;
        // Keeps copies of meshes in place, once all commands that read them are recorded.
        void retain_temporaries(Commands& commands);
    };
    Staged stage(Commands& commands, std::vector<Item> items) const;
    // Returns the slices, by item.
    std::vector<VertexSlice*> commit(Staged&& staged, SyncPoint done);

    // Waits. Downloads the part of the mesh that the host lacks, in units of the geometry's scale.
    void download(Geometry& geometry, const VertexSlice& slice) const;
    void warn_of_faults(const std::string& accel) { gather_.warn_of_faults(accel); }

  private:
    void record_positions(Commands& commands, const Staged& staged) const;

    Context& context_;
    MeshGather gather_;
    Kernel<CopyFloatsArgs> copy_floats_;
};

}  // namespace twinray
