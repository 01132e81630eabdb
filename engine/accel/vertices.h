// SPDX-License-Identifier: MIT
// Meshes in device memory whose vertices move.
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/accel/geometry.h"
#include "engine/accel/surface_area.h"
#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/copy_floats.h"
#include "twinray/glsl/cpp_end.h"

// A mesh in device memory: 3 floats a vertex, 3 indices a triangle. Null: it is on the host alone.
struct DeviceMesh {
    Floats positions;
    Uints indices;
};

// What the device has of one geometry's mesh and lacks. Nothing until a vertex is first moved, so that meshes that keep
// their shape do not pay; from then on the device's copy is what everything is built from.
struct VertexSlice {
    Buffer positions, indices;
    CostLog costs;              // of the geometry's tree
    bool edited = false;        // moved since the last sync, by the host, or by `incoming`
    bool device_wrote = false;  // positions that Geometry::positions lacks
    Floats incoming;            // device memory in the user's units that the next sync copies the positions from; 0 =
                                // Geometry::positions

    bool on_device() const { return indices.bytes() != 0; }
    std::uint64_t bytes() const { return positions.bytes() + indices.bytes() + costs.bytes(); }
    DeviceMesh mesh() const { return {positions.ref<float>(), indices.ref<uint>()}; }
};

// Brings moved vertices to the device.
class VertexArrays {
  public:
    explicit VertexArrays(Context& context);

    struct Item {
        const Geometry* geometry;  // has triangles
        VertexSlice* slice;        // edited, or not on the device yet
    };
    // What stage() recorded, to be committed once it is certain to run.
    struct Staged {
        std::vector<Item> items;
        std::vector<VertexSlice> made;  // by item: buffers for a slice that had none
        std::unordered_map<const VertexSlice*, std::size_t> item_of;
        DeviceMesh mesh(std::size_t item) const { return slice(item).mesh(); }
        // Null for a slice that is neither staged nor on the device.
        DeviceMesh mesh_of(const VertexSlice& slice) const;
        CostTarget cost_target(std::size_t item) const { return slice(item).costs.target(); }

      private:
        const VertexSlice& slice(std::size_t item) const {
            return items[item].slice->on_device() ? *items[item].slice : made[item];
        }
    };
    Staged stage(Commands& commands, std::vector<Item> items) const;
    // Returns the slices, by item.
    static std::vector<VertexSlice*> commit(Staged&& staged);

  private:
    Context& context_;
    Kernel<CopyFloatsArgs> copy_floats_;
};

}  // namespace twinray
