// SPDX-License-Identifier: MIT
// Bottom levels of HwTlas over meshes whose vertices are on the device.
#pragma once

#include "engine/accel/mesh_store.h"
#include "engine/core/radix_sort.h"
#include "hwtlas/blas.h"

namespace twinray {

// A mesh with moving vertices, all on the device, and at least one triangle.
struct MovingMesh {
    PackedMesh mesh;
    uint triangle_count;
    const Buffer* block;  // HwGeometry; gets the mesh's box, and by a build the addresses of `blas`
    const Blas* blas;     // can_update
    CostTarget cost;
};

// Builds bottom levels from vertices in device memory, and updates them. Kernels do what blas_input() does on the host:
// the box, the order for drivers that build in input order, and triangles without non-finite vertices.
class MovingBlasBuilder {
  public:
    MovingBlasBuilder(Context& context, bool reorder);

    // Makes room for a mesh of so many triangles, not built yet.
    Blas make(const std::string& name, uint triangle_count) const;
    // Returns the memory that building meshes on the device takes.
    BuildBytes bytes(std::span<const GeometrySize> meshes, std::uint64_t scratch_budget) const;
    // Works in batches whose scratch fits into `scratch_budget`. update: every mesh was built before.
    void record(Commands& commands, std::span<const MovingMesh> meshes, BuildMode mode,
                std::uint64_t scratch_budget) const;

  private:
    struct Batch;
    std::uint64_t scratch_bytes(uint triangle_count, BuildMode mode) const;
    Batch begin(Commands& commands, std::span<const MovingMesh> meshes, BuildMode mode, const Buffer& scratch) const;
    void record_batch(Commands& commands, Batch& batch) const;
    void record_order(Commands& commands, Batch& batch) const;

    Context& context_;
    bool reorder_;
    RadixSort sort_;
    SurfaceArea areas_;
    Kernel<HwTrianglesArgs> bound_, codes_, gather_;
};

}  // namespace twinray
