#include "swtlas/sw_backend.h"

#include "engine/accel/trace_program.h"
#include "engine/accel/world_bound.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <ranges>

#include "engine/accel/batches.h"
#include "engine/accel/mesh_store.h"
#include "engine/core/error.h"
#include "swtlas/triangle_pairs.h"
#include "swtlas_trace.spv.h"
#include "swtlas_trace_int64.spv.h"
#include "swtlas_trace_refined.spv.h"

namespace twinray {
namespace {

// Builds mark a record that no node leads to by one word; with 0 in its other words, equal trees are equal bytes.
std::vector<CompressedRecord> with_clear_gaps(std::vector<CompressedRecord> records) {
    for (CompressedRecord& record : records)
        if (is_none(record)) record = no_record();
    return records;
}

Bvh empty_bvh(std::uint64_t nodes) { return {vec3(INFINITY), vec3(-INFINITY), {nodes}, NOTHING, 0}; }

std::span<const std::uint32_t> own_module(const KernelTuning& tuning) {
    if (tuning.has_wide_loads) return swtlas_trace_int64_spirv;
    return swtlas_trace_spirv;
}

}  // namespace

// A mesh on the device.
struct SwBackend::Source {
    PackedMesh mesh;
    Ref<Leaf> leaves;  // null: each primitive is one, or the tree is there
};

struct SwBackend::Batch {
    std::span<const GeometryInput> inputs;
    std::vector<uint> counts = {};  // of leaves
    BuildPlan plan = {};

    // Returns the tree of input i.
    BuildTree tree(std::size_t i, const SwBuiltGeometry& target, const Source& source) const {
        return {plan.first[i],       counts[i],          source.mesh.positions,
                source.mesh.indices, source.leaves,      {inputs[i].block->address()},
                target.nodes(),      target.triangles(), target.records()};
    }
};

struct SwBackend::SwBuiltTlas : BuiltTlas {
    Buffer buffer;
    SceneLayout layout;

    BuildTree tree(uint count) const {
        BuildTree tree{};
        tree.count = count;
        tree.bvh = bvh();
        tree.nodes = nodes();
        tree.records = records();
        return tree;
    }
    Ref<Bvh> bvh() const { return {address + offsetof(SwTlasHeader, bvh)}; }
    Ref<BvhNode> nodes() const { return {layout.node_count ? address + layout.nodes : 0}; }
    Ref<SwInstance> instances() const { return {address + layout.instances}; }
    Ref<CompressedRecord> records() const { return {layout.record_count ? address + layout.records : 0}; }
};

// The memory that builds take.
struct SwBackend::Needs {
    Layout layout;
    const KernelTuning& tuning;
    std::uint64_t structures = 0;
    std::vector<std::uint64_t> shares = {};  // of scratch

    void add(uint leaf_count, std::size_t vertex_count, std::uint64_t sources);
};

SwBackend::SwBackend(Context& context, const AccelOptions& options)
    : AccelBackend(context, "SwTlas", options), builder_(context, options) {}

void SwBackend::prepare(Geometry& geometry) const {
    if (has_records(options().layout)) choose_leaves(geometry, keeps_meshes_on_device());
}

// Returns null if the mesh is only in host memory.
const PackedMesh& SwBackend::device_mesh(const GeometryInput& input) {
    return input.mesh.indices.address ? input.mesh : input.kept;
}

uint SwBackend::leaf_count_of(const GeometryInput& input) {
    if (input.current) return static_cast<const SwBuiltGeometry&>(*input.current).layout.leaf_count;
    return SwBuiltGeometry::leaf_count_of(*input.geometry);
}

// Returns the bytes that must be uploaded to build from it.
std::uint64_t SwBackend::source_bytes(const GeometryInput& input) {
    const Geometry& geometry = *input.geometry;
    const std::uint64_t leaves = std::span(geometry.leaves).size_bytes();
    if (device_mesh(input).indices.address) return leaves;
    const bool is_welded = !geometry.welded.is_empty();
    return std::span(geometry.boxes).size_bytes() + leaves +
           (is_welded ? geometry.welded.positions.size() : geometry.positions.size()) * sizeof(vec3) +
           (is_welded ? geometry.welded.triangles.size() : geometry.triangles.size()) * sizeof(uvec3);
}

// Calls `record` for one batch after the other, all in the same scratch: that of the build, then the sources.
void SwBackend::record_batches(Commands& commands, std::span<const GeometryInput> inputs,
                               const std::function<void(const Batch&, const Buffer& scratch)>& record) {
    std::vector<std::uint64_t> shares;
    for (const GeometryInput& input : inputs)
        shares.push_back(scratch_share(leaf_count_of(input), options().layout, context().state().tuning()) +
                         source_bytes(input));
    const Batches batches = cut_into_batches(shares, scratch_budget());
    Buffer scratch(context(),
                   {.name = "swtlas geometry scratch", .bytes = batches.scratch_bytes, .alignment = cache_line_bytes});
    for (const Batches::Run& run : batches.runs) {
        Batch batch{inputs.subspan(run.first, run.count)};
        for (const GeometryInput& input : batch.inputs) batch.counts.push_back(leaf_count_of(input));
        batch.plan = plan_build(batch.counts, options().layout, context().state().tuning());
        record(batch, scratch);
    }
    commands.retain(std::move(scratch));
}

std::vector<Builder::Measured> SwBackend::measured(const Batch& batch, std::span<const BuildTree> trees) {
    std::vector<Builder::Measured> wanted;
    for (std::size_t i = 0; i < trees.size(); ++i)
        if (const CostTarget& cost = batch.inputs[i].cost; cost.result.address)
            wanted.push_back({trees[i].bvh, trees[i].records, trees[i].count, cost});
    return wanted;
}

// Finds the meshes on the device; uploads those that are not there yet, and their leaves.
std::vector<SwBackend::Source> SwBackend::record_sources(Commands& commands, const Batch& batch, bool wants_leaves,
                                                         const Buffer& scratch) {
    MeshUpload upload(scratch, batch.plan.scratch.bytes);
    std::deque<HostMesh> on_host;
    std::vector<Source> sources;
    for (const GeometryInput& input : batch.inputs) {
        const Geometry& geometry = *input.geometry;
        sources.push_back({device_mesh(input), {}});
        auto& [mesh, leaves] = sources.back();
        if (!geometry.leaves.empty() && wants_leaves)
            leaves.address = upload.add(std::as_bytes(std::span(geometry.leaves)));
        if (mesh.indices.address) continue;
        if (geometry.kind == GEOMETRY_BOXES) {
            mesh.positions.address = upload.add(std::as_bytes(std::span(geometry.boxes)));
            continue;
        }
        on_host.emplace_back(geometry);
        mesh = upload.add(on_host.back().positions, on_host.back().triangles);
    }
    upload.record(commands);
    return sources;
}

// Makes the block of a tree that is still empty; `vertices`: null if its leaves name none.
SwGeometry SwBackend::block_of(const SwBuiltGeometry& built, Floats vertices, uint kind) const {
    SwGeometry block{empty_bvh(built.nodes().address), built.triangles(), built.records(), vertices, kind, 0};
    context().fill_absent(block.bvh.nodes, block.triangles, block.records, block.vertices);
    return block;
}

// Gives trees the vertices that their leaves name, if nothing else has them on the device.
void SwBackend::record_vertices(Commands& commands, const Batch& batch, std::span<const Source> sources,
                                const Buffer& scratch, std::span<const SwBuiltGeometry* const> targets) {
    const auto needs_them = [&](std::size_t i) {
        return targets[i]->layout.vertex_count != 0 && device_mesh(batch.inputs[i]).indices.address == 0;
    };
    const auto all = std::views::iota(std::size_t{0}, targets.size());
    if (std::ranges::none_of(all, needs_them)) return;
    const auto pass = commands.pass("swtlas vertices");
    for (const std::size_t i : all | std::views::filter(needs_them)) {
        const GeometryLayout& layout = targets[i]->layout;
        commands.copy(scratch, sources[i].mesh.positions.address - scratch.address(), targets[i]->buffer,
                      layout.vertices, layout.vertex_count * sizeof(vec3));
    }
}

void SwBackend::record_build(Commands& commands, const Batch& batch, const Buffer& scratch, Built& built) {
    std::vector<BuildTree> trees;
    std::vector<Source> sources;
    std::vector<const SwBuiltGeometry*> targets;
    {
        const auto pass = commands.pass("swtlas geometry input");
        sources = record_sources(commands, batch, true, scratch);
        for (std::size_t i = 0; i < batch.inputs.size(); ++i) {
            const GeometryInput& input = batch.inputs[i];
            std::unique_ptr<SwBuiltGeometry> made;
            const PackedMesh& mesh = device_mesh(input);
            if (!input.current)
                made = std::make_unique<SwBuiltGeometry>(context(), *input.geometry, mesh.indices.address != 0,
                                                         options().layout);
            const auto& target = made ? *made : static_cast<const SwBuiltGeometry&>(*input.current);
            commands.write(*input.block, block_of(target, mesh.positions.address ? mesh.positions : target.vertices(),
                                                  input.geometry->kind));
            trees.push_back(batch.tree(i, target, sources[i]));
            targets.push_back(&target);
            built.push_back(std::move(made));
        }
    }
    record_vertices(commands, batch, sources, scratch, targets);
    builder_.record_triangles(commands, batch.plan, trees, scratch);
    builder_.record_costs(commands, measured(batch, trees), true);
}

SwBackend::Built SwBackend::build_geometries(Commands& commands, std::span<const GeometryInput> inputs) {
    Built built;
    record_batches(commands, inputs,
                   [&](const Batch& batch, const Buffer& scratch) { record_build(commands, batch, scratch, built); });
    return built;
}

// The meshes are on the device. From now on leaves of two triangles name its vertices.
std::vector<SwBackend::Source> SwBackend::record_refit_sources(Commands& commands, const Batch& batch,
                                                               const Buffer& scratch) {
    const auto has_pairs = [](const GeometryInput& input) { return !input.geometry->leaves.empty(); };
    if (std::ranges::none_of(batch.inputs, has_pairs)) return record_sources(commands, batch, false, scratch);
    const auto pass = commands.pass("swtlas geometry input");
    for (const GeometryInput& input : batch.inputs | std::views::filter(has_pairs))
        commands.write(*input.block, input.mesh.positions, offsetof(SwGeometry, vertices));
    return record_sources(commands, batch, batch.plan.has_lone_leaves, scratch);
}

void SwBackend::record_refit(Commands& commands, const Batch& batch, const Buffer& scratch) {
    std::vector<BuildTree> trees;
    const std::vector<Source> sources = record_refit_sources(commands, batch, scratch);
    for (std::size_t i = 0; i < batch.inputs.size(); ++i)
        trees.push_back(batch.tree(i, static_cast<const SwBuiltGeometry&>(*batch.inputs[i].current), sources[i]));
    std::vector<Builder::Measured> as_built = measured(batch, trees);
    std::erase_if(as_built, [](const Builder::Measured& tree) { return !tree.target.is_first; });
    builder_.record_costs(commands, as_built, true);
    builder_.record_triangle_refit(commands, batch.plan, trees, scratch);
    builder_.record_costs(commands, measured(batch, trees), false);
}

SwBackend::Built SwBackend::refit_geometries(Commands& commands, std::span<const GeometryInput> inputs) {
    record_batches(commands, inputs,
                   [&](const Batch& batch, const Buffer& scratch) { record_refit(commands, batch, scratch); });
    return Built(inputs.size());
}

std::unique_ptr<AccelBackend::BuiltTlas> SwBackend::build_tlas(Commands& commands, const TlasInput& input,
                                                               const BuiltTlas* current) {
    const auto* scene = static_cast<const SwBuiltTlas*>(current);
    std::unique_ptr<SwBuiltTlas> made;
    if (const std::size_t capacity = capacity_for(input.count, scene ? scene->capacity : 0);
        !scene || capacity != scene->capacity) {
        made = std::make_unique<SwBuiltTlas>();
        made->capacity = capacity;
        made->layout = layout_scene(static_cast<uint>(capacity), options().layout);
        made->buffer =
            Buffer(context(), {.name = "SwTlas scene", .bytes = made->layout.bytes, .alignment = cache_line_bytes});
        made->address = made->buffer.address();
        made->bytes = made->buffer.bytes();
        scene = made.get();
    }
    SwTlasHeader header{input.header, empty_bvh(scene->nodes().address), scene->records(), scene->instances(),
                        input.count};
    context().fill_absent(header.bvh.nodes, header.records, header.instances);
    {
        const auto pass = commands.pass("swtlas scene input");
        commands.write(scene->buffer, header);
    }
    builder_.record_instances(commands,
                              plan_build(std::span(&input.count, 1), options().layout, context().state().tuning()),
                              {scene->tree(input.count), input.records, scene->instances()});
    record_costs(commands, input, *scene, true);
    return made;
}

// `sources`: the bytes that are uploaded.
void SwBackend::Needs::add(uint leaf_count, std::size_t vertex_count, std::uint64_t sources) {
    structures += layout_geometry(leaf_count, vertex_count, layout).bytes;
    shares.push_back(scratch_share(leaf_count, layout, tuning) + sources);
}

BuildBytes SwBackend::geometry_bytes(std::span<const GeometrySize> geometries) const {
    Needs needs{options().layout, context().state().tuning()};
    for (const GeometrySize& size : geometries)
        needs.add(static_cast<uint>(size.triangles), 0,
                  size.in_device_memory ? 0 : size.vertices * sizeof(vec3) + size.triangles * sizeof(uvec3));
    return {needs.structures, cut_into_batches(needs.shares, scratch_budget()).scratch_bytes};
}

BuildBytes SwBackend::bytes_of(std::span<const Geometry* const> geometries) const {
    Needs needs{options().layout, context().state().tuning()};
    for (const Geometry* geometry : geometries)
        needs.add(SwBuiltGeometry::leaf_count_of(*geometry),
                  SwBuiltGeometry::vertex_count_of(*geometry, keeps_meshes_on_device()),
                  keeps_meshes_on_device() ? std::span(geometry->leaves).size_bytes()
                                           : source_bytes({geometry, nullptr, {}, {}, nullptr, {}}));
    return {needs.structures, cut_into_batches(needs.shares, scratch_budget()).scratch_bytes};
}

BuildBytes SwBackend::scene_bytes(std::size_t count, std::size_t capacity) const {
    const auto leaves = static_cast<uint>(count);
    const BuildPlan plan = plan_build(std::span(&leaves, 1), options().layout, context().state().tuning());
    return {layout_scene(static_cast<uint>(capacity), options().layout).bytes,
            (plan.has_lone_leaves ? 0 : plan.scratch.bytes) + Builder::cost_bytes(leaves, options().layout)};
}

void SwBackend::refit_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) {
    const auto& scene = static_cast<const SwBuiltTlas&>(current);
    builder_.record_refit(commands,
                          plan_build(std::span(&input.count, 1), options().layout, context().state().tuning()),
                          {scene.tree(input.count), input.records, scene.instances()});
    record_costs(commands, input, scene, false);
}

void SwBackend::measure_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) const {
    record_costs(commands, input, static_cast<const SwBuiltTlas&>(current), true);
}

void SwBackend::record_costs(Commands& commands, const TlasInput& input, const SwBuiltTlas& scene,
                             bool is_build) const {
    if (!input.cost.result.address) return;
    const Builder::Measured measured{scene.bvh(), scene.records(), input.count, input.cost};
    builder_.record_costs(commands, std::span(&measured, 1), is_build);
}

std::unique_ptr<TraceProgram> SwBackend::create_program(const TraceProgramCode* code, uint features) const {
    return std::make_unique<KernelProgram>(
        context(), id(), features, code ? code->name : "swtlas_trace",
        code ? code->software : own_module(context().state().tuning()),
        code ? code->software_refined : std::span<const std::uint32_t>(swtlas_trace_refined_spirv), true);
}

BuiltTree SwBackend::download_geometry(AccelHandle handle) const {
    const auto& built = static_cast<const SwBuiltGeometry&>(built_geometry(handle));
    const SwGeometry block = download<SwGeometry>(context(), geometry_block(handle), 1).front();
    const GeometryLayout& layout = built.layout;
    std::vector<CompressedRecord> records =
        with_clear_gaps(download<CompressedRecord>(context(), built.buffer, layout.record_count, layout.records));
    SharedArray<vec3> vertices;
    if (layout.vertex_count && block.vertices.address == built.vertices().address)
        vertices = download<vec3>(context(), built.buffer, layout.vertex_count, layout.vertices);
    else if (has_pairs(records))
        vertices = geometry(handle).built_positions();
    return {block.bvh, download<BvhNode>(context(), built.buffer, layout.node_count, layout.nodes),
            download<BvhTriangle>(context(), built.buffer, layout.triangle_count, layout.triangles), std::move(records),
            std::move(vertices)};
}

BuiltTree SwBackend::download_scene() const {
    const auto& built = static_cast<const SwBuiltTlas&>(built_tlas());
    const Bvh bvh = download<SwTlasHeader>(context(), built.buffer, 1).front().bvh;
    const SceneLayout of_them = layout_scene(bvh.leaf_count, options().layout);
    return {bvh,
            download<BvhNode>(context(), built.buffer, of_them.node_count, built.layout.nodes),
            {},
            with_clear_gaps(
                download<CompressedRecord>(context(), built.buffer, of_them.record_count, built.layout.records)),
            {}};
}

}  // namespace twinray
