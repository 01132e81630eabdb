// SPDX-License-Identifier: MIT
#include "swtlas/sw_tlas.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "swtlas_trace.spv.h"

namespace twinray {
namespace {

KernelDesc trace_kernel(const char* name, uint query) {
    return {.name = name, .spirv = swtlas_trace_spirv, .group_size = 64, .constants = {{0, query}}};
}

Bvh empty_bvh(std::uint64_t nodes) { return {vec3(INFINITY), vec3(-INFINITY), {nodes}, NOTHING, 0}; }

}  // namespace

struct SwTlas::SwBuiltGeometry : BuiltGeometry {
    GeometryLayout layout;
    Buffer buffer;

    Ref<BvhTriangle> triangles() const { return buffer.ref<BvhTriangle>(layout.triangles); }
    SwGeometry block() const { return {empty_bvh(buffer.address() + layout.nodes), triangles()}; }
};

struct SwTlas::SwBuiltScene : BuiltScene {
    Buffer buffer;  // see layout_scene
    uint capacity = 0;

    BuildTree tree(uint count) const {
        BuildTree tree{};
        tree.count = count;
        tree.bvh = {address};
        return tree;
    }
    Ref<SwInstance> instances() const { return {address + layout_scene(capacity).instances}; }
};

SwTlas::SwTlas(Context& context)
    : AbstractAccel(context, "SwTlas"),
      builder_(context),
      trace_closest_(context, trace_kernel("swtlas_trace closest", QUERY_CLOSEST)),
      trace_any_(context, trace_kernel("swtlas_trace any", QUERY_ANY)) {}

std::vector<uint> SwTlas::triangle_counts(std::span<const GeometryInput> inputs) {
    std::vector<uint> counts;
    for (const GeometryInput& input : inputs) counts.push_back(static_cast<uint>(input.geometry->triangles.size()));
    return counts;
}

std::vector<Builder::Measured> SwTlas::measured(std::span<const GeometryInput> inputs) {
    std::vector<Builder::Measured> trees;
    for (const GeometryInput& input : inputs)
        if (input.cost.result.address)
            trees.push_back(
                {{input.block->address()}, static_cast<uint>(input.geometry->triangles.size()), input.cost});
    return trees;
}

// Where the meshes lie on the device; those that are not there yet are uploaded.
std::vector<DeviceMesh> SwTlas::record_meshes(Commands& commands, std::span<const GeometryInput> inputs) {
    std::vector<Commands::Piece> pieces;
    std::uint64_t bytes = 0;
    const auto place = [&](std::span<const std::byte> data) {
        pieces.push_back({bytes, data});
        bytes += data.size();
        return pieces.back().offset;
    };
    std::vector<DeviceMesh> meshes;
    for (const GeometryInput& input : inputs) {
        meshes.push_back(input.mesh);
        if (input.mesh.indices.address) continue;
        meshes.back().positions.address = place(std::as_bytes(std::span(input.geometry->positions)));
        meshes.back().indices.address = place(std::as_bytes(std::span(input.geometry->triangles)));
    }
    Buffer source(context(), {.name = "swtlas geometry input", .bytes = bytes});
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (inputs[i].mesh.indices.address) continue;
        meshes[i].positions.address += source.address();
        meshes[i].indices.address += source.address();
    }
    commands.upload_pieces(source, pieces);
    commands.keep(std::move(source));
    return meshes;
}

std::unique_ptr<SwTlas::SwBuiltGeometry> SwTlas::make_geometry(const Geometry& geometry) {
    auto made = std::make_unique<SwBuiltGeometry>();
    made->layout = layout_geometry(static_cast<uint>(geometry.triangles.size()));
    made->bytes = made->layout.bytes;
    made->buffer = Buffer(context(), {.name = "SwTlas geometry '" + geometry.name + "'", .bytes = made->bytes});
    return made;
}

std::vector<std::unique_ptr<AbstractAccel::BuiltGeometry>> SwTlas::build_geometries(
    Commands& commands, std::span<const GeometryInput> inputs) {
    if (inputs.empty()) return {};
    const std::vector<uint> counts = triangle_counts(inputs);
    const BuildPlan plan = plan_build(counts);
    std::vector<std::unique_ptr<BuiltGeometry>> built;
    std::vector<BuildTree> trees;
    {
        const auto pass = commands.pass("swtlas geometry input");
        const std::vector<DeviceMesh> meshes = record_meshes(commands, inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            std::unique_ptr<SwBuiltGeometry> made;
            if (!inputs[i].current) made = make_geometry(*inputs[i].geometry);
            const auto& target = made ? *made : static_cast<const SwBuiltGeometry&>(*inputs[i].current);
            commands.write(*inputs[i].block, target.block());
            trees.push_back({plan.first[i],
                             counts[i],
                             meshes[i].positions,
                             meshes[i].indices,
                             target.triangles(),
                             {inputs[i].block->address()}});
            built.push_back(std::move(made));
        }
    }
    builder_.record_triangles(commands, plan, trees);
    builder_.record_costs(commands, measured(inputs), true);
    return built;
}

std::vector<std::unique_ptr<AbstractAccel::BuiltGeometry>> SwTlas::refit_geometries(
    Commands& commands, std::span<const GeometryInput> inputs) {
    const std::vector<uint> counts = triangle_counts(inputs);
    const BuildPlan plan = plan_build(counts);
    std::vector<BuildTree> trees;
    for (std::size_t i = 0; i < inputs.size(); ++i)
        trees.push_back({plan.first[i],
                         counts[i],
                         inputs[i].mesh.positions,
                         inputs[i].mesh.indices,
                         static_cast<const SwBuiltGeometry&>(*inputs[i].current).triangles(),
                         {inputs[i].block->address()}});
    std::vector<Builder::Measured> costs = measured(inputs);
    std::erase_if(costs, [](const Builder::Measured& tree) { return !tree.target.is_first; });
    builder_.record_costs(commands, costs, true);
    builder_.record_triangle_refit(commands, plan, trees);
    builder_.record_costs(commands, measured(inputs), false);
    return std::vector<std::unique_ptr<BuiltGeometry>>(inputs.size());
}

std::unique_ptr<AbstractAccel::BuiltScene> SwTlas::build_scene(Commands& commands, const SceneInput& input,
                                                               const BuiltScene* current) {
    const auto* scene = static_cast<const SwBuiltScene*>(current);
    std::unique_ptr<SwBuiltScene> made;
    if (const auto capacity = static_cast<uint>(capacity_for(input.count, scene ? scene->capacity : 0));
        !scene || capacity != scene->capacity) {
        made = std::make_unique<SwBuiltScene>();
        made->capacity = capacity;
        made->buffer = Buffer(context(), {.name = "SwTlas scene", .bytes = layout_scene(capacity).bytes});
        made->address = made->buffer.address();
        made->bytes = made->buffer.bytes();
        scene = made.get();
    }
    const SwScene header{empty_bvh(scene->address + layout_scene(scene->capacity).nodes), scene->instances(),
                         input.count};
    {
        const auto pass = commands.pass("swtlas scene input");
        commands.write(scene->buffer, header);
    }
    builder_.record_instances(commands, plan_build(std::span(&input.count, 1)), scene->tree(input.count), input.records,
                              scene->instances());
    const Builder::Measured measured{{scene->address}, input.count, input.cost};
    builder_.record_costs(commands, std::span(&measured, 1), true);
    return made;
}

void SwTlas::refit_scene(Commands& commands, const SceneInput& input, const BuiltScene& current) {
    const auto& scene = static_cast<const SwBuiltScene&>(current);
    builder_.record_refit(commands, plan_build(std::span(&input.count, 1)), scene.tree(input.count), input.records,
                          scene.instances());
    const Builder::Measured measured{{scene.address}, input.count, input.cost};
    builder_.record_costs(commands, std::span(&measured, 1), false);
}

void SwTlas::record_trace(Commands& commands, const TraceDesc& desc, std::uint64_t scene) const {
    const SwTraceArgs args{
        {scene},   desc.rays,           desc.hits, desc.indirect_count, static_cast<uint>(desc.count),
        desc.mask, flags_of(desc.cull), 0};
    (desc.query == Query::any ? trace_any_ : trace_closest_).dispatch(commands, args, desc.count);
}

SwTlas::Tree SwTlas::download_geometry(AccelHandle handle) const {
    const auto& built = static_cast<const SwBuiltGeometry&>(built_geometry(handle));
    const Bvh bvh = download<SwGeometry>(context(), geometry_block(handle), 1).front().bvh;
    const GeometryLayout layout = layout_geometry(bvh.leaf_count);
    return {bvh, download<BvhNode>(context(), built.buffer, std::max(bvh.leaf_count, 1u) - 1, layout.nodes),
            download<BvhTriangle>(context(), built.buffer, bvh.leaf_count, layout.triangles)};
}

SwTlas::Tree SwTlas::download_scene() const {
    const auto& built = static_cast<const SwBuiltScene&>(built_scene());
    const Bvh bvh = download<SwScene>(context(), built.buffer, 1).front().bvh;
    const SceneLayout layout = layout_scene(built.capacity);
    return {bvh, download<BvhNode>(context(), built.buffer, std::max(bvh.leaf_count, 1u) - 1, layout.nodes), {}};
}

}  // namespace twinray
