#include "hwtlas/blas.h"

#include <cmath>
#include <utility>

#include "engine/accel/batches.h"
#include "hwtlas_gather_triangles.spv.h"
#include "hwtlas_triangle_bound.spv.h"
#include "hwtlas_triangle_codes.spv.h"

namespace twinray {
namespace {

// Each triangle has three vertices of its own.
StructureBuild build_of(const std::string& name, std::uint64_t vertices, uint triangle_count) {
    StructureBuild build = triangle_build(name, vertices, 3 * triangle_count, triangle_count);
    build.geometry.geometry.triangles.indexType = VK_INDEX_TYPE_NONE_KHR;
    build.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
    return build;
}

constexpr std::uint64_t part_alignment = 16;  // of all parts of scratch memory
constexpr std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + part_alignment - 1) / part_alignment * part_alignment;
}

RadixSort::Scratch sort_at(std::uint64_t address, uint count) { return {address, count, part_alignment}; }

std::uint64_t vertex_bytes(uint triangle_count) { return aligned(std::uint64_t{triangle_count} * 3 * sizeof(vec3)); }

AreaWork area_of(const MovingMesh& mesh, BuildMode mode) {
    return {mesh.triangle_count, {mesh.block->address()}, mesh.cost, mode == BuildMode::build};
}

StructureWork work_of(const MovingMesh& mesh, BuildMode mode, Floats vertices) {
    return {build_of("", vertices.address, mesh.triangle_count), mode, &mesh.blas->structure};
}

}  // namespace

struct MovingBlasBuilder::Batch {
    std::vector<HwTrianglesArgs> args;
    std::vector<RadixSort::Scratch> sorts;
    std::vector<AreaWork> areas;
    std::vector<StructureWork> work;
    std::uint64_t build_scratch = 0;

    void dispatch(Commands& commands, const Kernel<HwTrianglesArgs>& kernel) const {
        const auto pass = commands.pass(kernel.name());
        for (const HwTrianglesArgs& mesh : args) kernel.dispatch_groups(commands, mesh, mesh.group_count);
    }
};

MovingBlasBuilder::MovingBlasBuilder(Context& context, bool reorder)
    : context_(context),
      reorder_(reorder),
      sort_(context),
      areas_(context),
      bound_(context, lazy_kernel("hwtlas_triangle_bound", hwtlas_triangle_bound_spirv, WORLD_BOUND_GROUP)),
      codes_(context, lazy_kernel("hwtlas_triangle_codes", hwtlas_triangle_codes_spirv, WORLD_BOUND_GROUP)),
      gather_(context, lazy_kernel("hwtlas_gather_triangles", hwtlas_gather_triangles_spirv, WORLD_BOUND_GROUP)) {}

Blas MovingBlasBuilder::make(const std::string& name, uint triangle_count) const {
    Blas blas;
    blas.can_update = true;
    const StructureBuild build = build_of(name, 0, triangle_count);
    blas.structure =
        AccelerationStructure(context_, build.name, build.type, sizes_of(context_, build).accelerationStructureSize);
    if (reorder_)
        blas.original = std::make_shared<const Buffer>(
            context_, BufferDesc{.name = "blas order " + name, .bytes = std::uint64_t{triangle_count} * sizeof(uint)});
    return blas;
}

BuildBytes MovingBlasBuilder::bytes(std::span<const GeometrySize> meshes, std::uint64_t scratch_budget) const {
    BuildBytes bytes;
    std::vector<std::uint64_t> scratch;
    for (const GeometrySize& mesh : meshes) {
        if (mesh.triangles == 0 || !mesh.in_device_memory) continue;
        const auto count = static_cast<uint>(mesh.triangles);
        bytes.structures += sizes_of(context_, build_of("", 0, count)).accelerationStructureSize +
                            (reorder_ ? mesh.triangles * sizeof(uint) : 0);
        scratch.push_back(scratch_bytes(count, BuildMode::build));
    }
    bytes.scratch = cut_into_batches(scratch, scratch_budget).scratch_bytes;
    return bytes;
}

// The driver's scratch comes first, with the alignment that it wants.
std::uint64_t MovingBlasBuilder::scratch_bytes(uint n, BuildMode mode) const {
    return scratch_bytes_of(context_, {build_of("", 0, n), mode, nullptr}) + vertex_bytes(n) + sizeof(WorldBoundBits) +
           aligned(AreaWork{n, {}, {}, mode == BuildMode::build}.bytes()) +
           (reorder_ && mode == BuildMode::build ? aligned(sort_at(0, n).bytes(context_.state().tuning())) : 0);
}

MovingBlasBuilder::Batch MovingBlasBuilder::begin(Commands& commands, std::span<const MovingMesh> meshes,
                                                  BuildMode mode, const Buffer& scratch) const {
    Batch batch;
    batch.build_scratch = scratch.address();
    std::uint64_t next = scratch.address();
    const auto take = [&](std::uint64_t bytes) { return std::exchange(next, next + bytes); };
    for (const MovingMesh& mesh : meshes) take(scratch_bytes_of(context_, work_of(mesh, mode, {})));
    const std::uint64_t bits = take(meshes.size() * sizeof(WorldBoundBits));
    for (const MovingMesh& mesh : meshes) {
        const uint n = mesh.triangle_count;
        batch.areas.push_back(area_of(mesh, mode));
        SurfaceArea::place(take(aligned(batch.areas.back().bytes())), std::span(&batch.areas.back(), 1));
        if (reorder_ && mode == BuildMode::build)
            batch.sorts.push_back(sort_at(take(aligned(sort_at(0, n).bytes(context_.state().tuning()))), n));
        const Floats vertices{take(vertex_bytes(n))};
        batch.work.push_back(work_of(mesh, mode, vertices));
        batch.args.push_back({mesh.mesh.positions,
                              mesh.mesh.indices,
                              mesh.block->ref<HwGeometry>(),
                              {bits + batch.args.size() * sizeof(WorldBoundBits)},
                              {},
                              {},
                              mesh.blas->table(),
                              vertices,
                              batch.areas.back().items,
                              n,
                              (n + WORLD_BOUND_GROUP - 1) / WORLD_BOUND_GROUP});
    }
    const WorldBoundBits none{uvec3(ordered_bits(INFINITY)), uvec3(ordered_bits(-INFINITY)), 0, 0};
    const auto pass = commands.pass("hwtlas blas bounds");
    commands.upload(scratch, std::span<const WorldBoundBits>(std::vector(meshes.size(), none)),
                    bits - scratch.address());
    return batch;
}

void MovingBlasBuilder::record_order(Commands& commands, Batch& batch) const {
    for (std::size_t i = 0; i < batch.sorts.size(); ++i) {
        const RadixSort::Scratch& sort = batch.sorts[i];
        HwTrianglesArgs& args = batch.args[i];
        args.keys = sort.pairs().keys;
        codes_.dispatch(commands, args, args.count);
        args.order = sort_.record_iota(commands, sort, morton_bits).values;
    }
}

void MovingBlasBuilder::record_batch(Commands& commands, Batch& batch) const {
    batch.dispatch(commands, bound_);
    record_order(commands, batch);
    batch.dispatch(commands, gather_);
    areas_.record(commands, std::move(batch.areas));
    const bool is_update = batch.work.front().mode == BuildMode::update;
    record_builds(commands, is_update ? "hwtlas_update_blases" : "hwtlas_build_blases", batch.work,
                  batch.build_scratch);
}

void MovingBlasBuilder::record(Commands& commands, std::span<const MovingMesh> meshes, BuildMode mode,
                               std::uint64_t scratch_budget) const {
    if (meshes.empty()) return;
    if (mode == BuildMode::build) {
        const auto pass = commands.pass("hwtlas geometry blocks");
        for (const MovingMesh& mesh : meshes) commands.write(*mesh.block, mesh.blas->block(context_));
    }
    std::vector<std::uint64_t> bytes;
    for (const MovingMesh& mesh : meshes) bytes.push_back(scratch_bytes(mesh.triangle_count, mode));
    const Batches batches = cut_into_batches(bytes, scratch_budget);
    Buffer scratch = make_build_scratch(context_, "moving blas scratch", batches.scratch_bytes);
    for (const Batches::Run& run : batches.runs) {
        Batch batch = begin(commands, meshes.subspan(run.first, run.count), mode, scratch);
        record_batch(commands, batch);
    }
    commands.retain(std::move(scratch));
}

}  // namespace twinray
