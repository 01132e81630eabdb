// SPDX-License-Identifier: MIT
#include "swtlas/sw_tlas.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "swtlas/built.h"
#include "swtlas_trace.spv.h"

namespace twinray {
namespace {

Bvh empty_bvh(std::uint64_t nodes) { return {vec3(INFINITY), vec3(-INFINITY), {nodes}, NOTHING, 0}; }

}  // namespace

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

SwTlas::SwTlas(Context& context) : AbstractAccel(context, "SwTlas"), builder_(context) {}

Capability SwTlas::capability_on(const DeviceFacts&, Feature feature) {
    switch (feature) {
        case Feature::level_refined:
        case Feature::level_certified: return {feature, Support::unsupported, "the software traversal is watertight"};
        case Feature::compaction: return {feature, Support::native, "its arrays have their exact size when built"};
        default: return {feature, Support::native, ""};
    }
}

std::vector<std::unique_ptr<AbstractAccel::BuiltGeometry>> SwTlas::build_geometries(
    Commands& commands, std::span<const GeometryInput> inputs) {
    if (inputs.empty()) return {};
    std::vector<uint> counts;
    std::vector<Commands::Piece> pieces;
    std::uint64_t bytes = 0;
    const auto place = [&](std::span<const std::byte> data) {
        pieces.push_back({bytes, data});
        bytes += data.size();
    };
    for (const GeometryInput& input : inputs) {
        counts.push_back(static_cast<uint>(input.geometry->primitive_count()));
        place(std::as_bytes(std::span(input.geometry->positions)));
        place(std::as_bytes(std::span(input.geometry->boxes)));
        place(std::as_bytes(std::span(input.geometry->triangles)));
    }
    const BuildPlan plan = plan_build(counts);
    Buffer source(context(), {.name = "swtlas geometry input", .bytes = bytes});
    std::vector<std::unique_ptr<BuiltGeometry>> built;
    std::vector<BuildTree> trees;
    {
        const auto pass = commands.pass("swtlas geometry input");
        commands.upload_pieces(source, pieces);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const GeometryLayout layout = layout_geometry(counts[i]);
            auto made = std::make_unique<SwBuiltGeometry>(context(), inputs[i].geometry->name, layout.bytes);
            const std::uint64_t base = made->buffer.address();
            const Geometry& geometry = *inputs[i].geometry;
            const bool has_boxes = geometry.kind == GEOMETRY_BOXES;
            const SwGeometry block{empty_bvh(base + layout.nodes), {base + layout.triangles}, geometry.kind, 0};
            commands.write(*inputs[i].block, block);
            trees.push_back({plan.first[i],
                             counts[i],
                             {source.address() + pieces[3 * i + (has_boxes ? 1 : 0)].offset},
                             {has_boxes ? 0 : source.address() + pieces[3 * i + 2].offset},
                             block.triangles,
                             {inputs[i].block->address()}});
            built.push_back(std::move(made));
        }
    }
    commands.keep(std::move(source));
    builder_.record_triangles(commands, plan, trees);
    return built;
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
    return made;
}

void SwTlas::refit_scene(Commands& commands, const SceneInput& input, const BuiltScene& current) {
    const auto& scene = static_cast<const SwBuiltScene&>(current);
    builder_.record_refit(commands, plan_build(std::span(&input.count, 1)), scene.tree(input.count), input.records,
                          scene.instances());
}

std::unique_ptr<TraceProgram> SwTlas::create_program(const TraceProgramCode* code, uint features) const {
    return std::make_unique<KernelProgram>(context(), id(), features, code ? code->name : "swtlas_trace",
                                           code ? code->software : std::span<const std::uint32_t>(swtlas_trace_spirv));
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
