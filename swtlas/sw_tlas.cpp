// SPDX-License-Identifier: MIT
#include "swtlas/sw_tlas.h"

#include <algorithm>
#include <optional>

#include "engine/core/error.h"
#include "swtlas_trace.spv.h"

namespace twinray {
namespace {

KernelDesc trace_kernel(const char* name, uint query) {
    return {.name = name, .spirv = swtlas_trace_spirv, .group_size = 64, .constants = {{0, query}}};
}

Bvh empty_bvh(std::uint64_t nodes) { return {{nodes}, NOTHING, 0, vec3(INFINITY), vec3(-INFINITY)}; }

}  // namespace

struct SwTlas::SwBuiltGeometry : BuiltGeometry {
    Buffer buffer;
};

struct SwTlas::SwBuiltScene : BuiltScene {
    Buffer buffer;
};

SwTlas::SwTlas(Context& context)
    : AbstractAccel(context, "SwTlas"),
      builder_(context),
      trace_closest_(context, trace_kernel("swtlas_trace closest", QUERY_CLOSEST)),
      trace_any_(context, trace_kernel("swtlas_trace any", QUERY_ANY)) {}

std::vector<std::unique_ptr<AbstractAccel::BuiltGeometry>> SwTlas::build_geometries(
    Commands& commands, std::span<const Geometry* const> geometries) {
    std::vector<uint> counts;
    std::uint64_t input_bytes = 0;
    for (const Geometry* geometry : geometries) {
        counts.push_back(static_cast<uint>(geometry->triangles.size()));
        input_bytes += std::span(geometry->positions).size_bytes() + std::span(geometry->triangles).size_bytes();
    }
    const BuildPlan plan = plan_build(counts);
    Buffer input(context(), {.name = "swtlas geometry input", .bytes = input_bytes});
    std::vector<std::unique_ptr<BuiltGeometry>> built;
    std::vector<BuildTree> trees;
    std::uint64_t offset = 0;
    std::optional<Commands::Pass> pass;
    if (!geometries.empty()) pass.emplace(commands, "swtlas geometry input");
    for (std::size_t i = 0; i < geometries.size(); ++i) {
        const Geometry& geometry = *geometries[i];
        const GeometryLayout layout = layout_geometry(counts[i]);
        auto made = std::make_unique<SwBuiltGeometry>();
        made->buffer = Buffer(context(), {.name = "SwTlas geometry '" + geometry.name + "'", .bytes = layout.bytes});
        made->reference = made->buffer.address();
        made->bytes = layout.bytes;
        const SwGeometry header{empty_bvh(made->reference + layout.nodes), {made->reference + layout.triangles}};
        commands.upload(made->buffer, std::span(&header, 1));

        const std::uint64_t indices = offset + std::span(geometry.positions).size_bytes();
        commands.upload(input, std::span(geometry.positions), offset);
        commands.upload(input, std::span(geometry.triangles), indices);
        trees.push_back({plan.first[i],
                         counts[i],
                         {input.address() + offset},
                         {input.address() + indices},
                         header.triangles,
                         {made->reference}});
        offset = indices + std::span(geometry.triangles).size_bytes();
        built.push_back(std::move(made));
    }
    pass.reset();
    commands.keep(std::move(input));
    builder_.record_triangles(commands, plan, trees);
    return built;
}

std::unique_ptr<AbstractAccel::BuiltScene> SwTlas::build_scene(Commands& commands,
                                                               std::span<const PlacedInstance> instances) {
    const auto count = static_cast<uint>(instances.size());
    const SceneLayout layout = layout_scene(count);
    auto built = std::make_unique<SwBuiltScene>();
    built->buffer = Buffer(context(), {.name = "SwTlas scene", .bytes = layout.bytes});
    built->address = built->buffer.address();
    built->bytes = layout.bytes;
    const SwScene header{empty_bvh(built->address + layout.nodes), {built->address + layout.instances}, count};

    std::vector<InstanceRecord> records;
    for (const PlacedInstance& instance : instances) records.push_back(instance.record);
    Buffer record_buffer(context(), {.name = "swtlas instance records", .bytes = std::span(records).size_bytes()});
    {
        const auto pass = commands.pass("swtlas instance input");
        commands.upload(built->buffer, std::span(&header, 1));
        commands.upload(record_buffer, std::span<const InstanceRecord>(records));
    }
    BuildTree tree{};
    tree.count = count;
    tree.bvh = {built->address};
    builder_.record_instances(commands, plan_build(std::span(&count, 1)), tree, record_buffer.ref<InstanceRecord>(),
                              header.instances);
    commands.keep(std::move(record_buffer));
    return built;
}

void SwTlas::record_trace(Commands& commands, const TraceDesc& desc, std::uint64_t scene) const {
    const SwTraceArgs args{{scene}, desc.rays, desc.hits, static_cast<uint>(desc.count), desc.mask};
    (desc.query == Query::any ? trace_any_ : trace_closest_).dispatch(commands, args, desc.count);
}

SwTlas::Tree SwTlas::download_geometry(AccelHandle handle) const {
    const auto& built = static_cast<const SwBuiltGeometry&>(built_geometry(handle));
    const SwGeometry header = download<SwGeometry>(context(), built.buffer, 1).front();
    const GeometryLayout layout = layout_geometry(header.bvh.leaf_count);
    return {header.bvh,
            download<BvhNode>(context(), built.buffer, std::max(header.bvh.leaf_count, 1u) - 1, layout.nodes),
            download<BvhTriangle>(context(), built.buffer, header.bvh.leaf_count, layout.triangles)};
}

SwTlas::Tree SwTlas::download_scene() const {
    const auto& built = static_cast<const SwBuiltScene&>(built_scene());
    const SwScene header = download<SwScene>(context(), built.buffer, 1).front();
    const SceneLayout layout = layout_scene(header.bvh.leaf_count);
    return {header.bvh,
            download<BvhNode>(context(), built.buffer, std::max(header.bvh.leaf_count, 1u) - 1, layout.nodes),
            {}};
}

}  // namespace twinray
