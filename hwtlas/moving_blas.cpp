// SPDX-License-Identifier: MIT
#include "hwtlas/moving_blas.h"

#include <cmath>
#include <utility>

#include "hwtlas_gather_triangles.spv.h"
#include "hwtlas_triangle_bound.spv.h"
#include "hwtlas_triangle_codes.spv.h"

namespace twinray {
namespace {

constexpr std::uint32_t morton_bits = 30;

KernelDesc kernel(const char* name, std::span<const std::uint32_t> spirv) {
    return {.name = name, .spirv = spirv, .group_size = WORLD_BOUND_GROUP};
}

// Three corners of its own for each triangle.
StructureBuild build_of(const std::string& name, std::uint64_t corners, uint triangle_count) {
    StructureBuild build = triangle_build(name, corners, 3 * triangle_count, triangle_count);
    build.geometry.geometry.triangles.indexType = VK_INDEX_TYPE_NONE_KHR;
    build.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
    return build;
}

}  // namespace

struct MovingBlasBuilder::Batch {
    std::span<const MovingMesh> meshes;
    std::vector<HwTrianglesArgs> args;
    std::vector<AreaWork> areas;

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
      bound_(context, kernel("hwtlas_triangle_bound", hwtlas_triangle_bound_spirv)),
      codes_(context, kernel("hwtlas_triangle_codes", hwtlas_triangle_codes_spirv)),
      gather_(context, kernel("hwtlas_gather_triangles", hwtlas_gather_triangles_spirv)) {}

Blas MovingBlasBuilder::make(const std::string& name, uint triangle_count) const {
    Blas blas;
    blas.can_update = true;
    const StructureBuild build = build_of(name, 0, triangle_count);
    blas.structure =
        AccelerationStructure(context_, build.name, build.type, sizes_of(context_, build).accelerationStructureSize);
    if (reorder_)
        blas.original_triangles = std::make_shared<const Buffer>(
            context_, BufferDesc{.name = "blas order " + name, .bytes = std::uint64_t{triangle_count} * sizeof(uint)});
    return blas;
}

MovingBlasBuilder::Batch MovingBlasBuilder::begin(Commands& commands, std::span<const MovingMesh> meshes,
                                                  BuildMode mode) const {
    const WorldBoundBits none{uvec3(ordered_bits(INFINITY)), uvec3(ordered_bits(-INFINITY)), 0, 0};
    std::uint64_t corner_bytes = 0;
    for (const MovingMesh& mesh : meshes) corner_bytes += std::uint64_t{mesh.triangle_count} * 3 * sizeof(vec3);
    Buffer bits(context_, {.name = "blas bounds", .bytes = meshes.size() * sizeof none});
    Buffer corners(context_, {.name = "blas corners", .bytes = corner_bytes});
    {
        const auto pass = commands.pass("hwtlas blas bounds");
        commands.upload(bits, std::span<const WorldBoundBits>(std::vector(meshes.size(), none)));
    }
    Batch batch{meshes, {}, {}};
    for (const MovingMesh& mesh : meshes)
        batch.areas.push_back({mesh.triangle_count, {mesh.block->address()}, mesh.cost, mode == BuildMode::build});
    areas_.reserve(commands, batch.areas);
    std::uint64_t next = 0;
    for (const MovingMesh& mesh : meshes) {
        const uint n = mesh.triangle_count;
        batch.args.push_back({mesh.mesh.positions,
                              mesh.mesh.indices,
                              mesh.block->ref<HwGeometry>(),
                              bits.ref<WorldBoundBits>(batch.args.size() * sizeof none),
                              {},
                              {},
                              mesh.blas->table(),
                              corners.ref<float>(next),
                              batch.areas[batch.args.size()].items,
                              n,
                              (n + WORLD_BOUND_GROUP - 1) / WORLD_BOUND_GROUP});
        next += std::uint64_t{n} * 3 * sizeof(vec3);
    }
    commands.keep(std::move(bits));
    commands.keep(std::move(corners));
    return batch;
}

void MovingBlasBuilder::record_order(Commands& commands, Batch& batch) const {
    for (HwTrianglesArgs& args : batch.args) {
        const std::uint64_t bytes = (std::uint64_t{args.count} * sizeof(uint) + 15) / 16 * 16;
        Buffer scratch(context_,
                       {.name = "blas sort scratch", .bytes = 4 * bytes + RadixSort::counter_bytes(args.count)});
        const auto part = [&](std::uint64_t i) { return scratch.ref<uint>(i * bytes); };
        args.keys = part(0);
        args.order = part(1);
        codes_.dispatch(commands, args, args.count);
        const RadixSort::Pairs sorted =
            sort_.record(commands, {part(0), part(1)}, {part(2), part(3)}, part(4), args.count, morton_bits);
        args.order = sorted.values;
        commands.keep(std::move(scratch));
    }
}

void MovingBlasBuilder::record_structures(Commands& commands, const Batch& batch, BuildMode mode) const {
    std::vector<StructureWork> work;
    for (std::size_t i = 0; i < batch.meshes.size(); ++i)
        work.push_back(
            {build_of("", batch.args[i].corners.address, batch.args[i].count), mode, &batch.meshes[i].blas->structure});
    record_builds(commands, mode == BuildMode::build ? "hwtlas_build_blases" : "hwtlas_update_blases", work);
}

void MovingBlasBuilder::record(Commands& commands, std::span<const MovingMesh> meshes, BuildMode mode) const {
    if (meshes.empty()) return;
    if (mode == BuildMode::build) {
        const auto pass = commands.pass("hwtlas geometry blocks");
        for (const MovingMesh& mesh : meshes) commands.write(*mesh.block, mesh.blas->block());
    }
    Batch batch = begin(commands, meshes, mode);
    batch.dispatch(commands, bound_);
    if (reorder_ && mode == BuildMode::build) record_order(commands, batch);
    batch.dispatch(commands, gather_);
    areas_.record(commands, std::move(batch.areas));
    record_structures(commands, batch, mode);
}

}  // namespace twinray
