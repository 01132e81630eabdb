// SPDX-License-Identifier: MIT
// Bottom levels of HwTlas over meshes in host memory, and the structs that its kernels share with C++.
#pragma once

#include <memory>
#include <vector>

#include <twinray/abstract_accel.h>

#include "engine/accel/geometry.h"
#include "engine/accel/surface_area.h"
#include "engine/accel/world_bound.h"
#include "hwtlas/acceleration_structure.h"

namespace twinray {
using std::uint64_t;
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/hw_tlas_header.h"
#include "shaders/shared/hw_build.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(HwGeometry) == 48 && sizeof(HwInstance) == 16 && sizeof(HwTlasHeader) == 32 &&
              sizeof(HwTrianglesArgs) == 80 && sizeof(HwGatherArgs) == 40 && sizeof(HwAreasArgs) == 32);

// The driver's input for a mesh: only finite positions, and one triangle for each triangle of the mesh. An inactive one
// (a non-finite vertex, no area) keeps its index but is collapsed to a point. Vulkan defines nothing for an infinite
// vertex, and a driver may let a NaN leak into the boxes of the triangles beside it, or hit triangles without area.
struct BlasInput {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    std::vector<Bounds> boxes;   // instead of both
    Bounds bounds;               // of the active primitives
    std::vector<uint> original;  // index in `triangles` or `boxes` -> the user's index; empty: not reordered

    bool is_empty() const { return bounds.is_empty(); }  // there is nothing that could be hit
};

// Returns the driver's input: a pure function. reorder: along a Morton curve.
BlasInput blas_input(const Geometry& geometry, bool reorder);

// The built form of one geometry. It has no structure if nothing can be hit: Vulkan takes an instance of address 0 as
// inactive.
struct Blas {
    uint kind = GEOMETRY_TRIANGLES;
    Bounds bounds;  // of the active primitives; empty where the device alone knows them
    AccelerationStructure structure;
    std::shared_ptr<const Buffer> original;     // see BlasInput, uint each; null when the order was kept
    bool can_update = false;                    // made by MovingBlasBuilder; others may be compacted, once
    std::shared_ptr<CompactedSizes> compacted;  // null: cannot be compacted
    std::size_t compacted_index = 0;            // in `compacted`

    Uints table() const { return original ? original->ref<uint>() : Uints{}; }
    HwGeometry block(const Context& context) const {
        HwGeometry block{bounds.lo, bounds.hi, structure.address(), table(), kind, 0};
        context.fill_absent(block.triangles);
        return block;
    }
    std::uint64_t bytes() const { return structure.bytes() + (original ? original->bytes() : 0); }
};

// Describes a build of triangles from a device address; with uint indices unless the caller changes that.
StructureBuild triangle_build(const std::string& name, std::uint64_t positions, std::size_t vertex_count,
                              std::size_t triangle_count);

struct BlasOptions {
    bool reorder;                  // presort for drivers that build in input order
    std::uint64_t scratch_budget;  // bytes
};
// Records the upload and build of all of them, in order.
std::vector<Blas> build_blases(Commands& commands, std::span<const Geometry* const> geometries,
                               const BlasOptions& options);

// Returns the memory that this takes for meshes of triangles on the host.
BuildBytes blas_bytes(const Context& context, std::span<const GeometrySize> meshes, const BlasOptions& options);

}  // namespace twinray
