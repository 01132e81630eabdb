// Bottom levels of HwTlas over meshes in host memory and on the device, and the structs that its kernels share with
// C++.
#pragma once

#include <memory>
#include <vector>

#include "engine/accel/accel_backend.h"
#include "engine/accel/mesh_store.h"
#include "engine/accel/world_bound.h"
#include "engine/core/radix_sort.h"
#include "hwtlas/acceleration_structure.h"

namespace twinray {
using std::uint64_t;
#include "twinray/glsl/cpp_begin.h"
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
struct Blas : AccelBackend::BuiltGeometry {
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
