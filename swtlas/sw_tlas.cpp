// The calls of SwTlas; saves its structures, and loads them.
#include <twinray/tlas.h>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "swtlas/sw_backend.h"
#include "swtlas/saved.h"
#include "swtlas/triangle_pairs.h"

namespace twinray {

SwTlas::SwTlas(Context& context, const AccelOptions& options)
    : AbstractAccel(std::make_unique<SwBackend>(context, options)) {}

SwBackend& SwTlas::backend() const { return static_cast<SwBackend&>(AbstractAccel::backend()); }

Capability SwTlas::capability_on(const DeviceProperties& device, Feature feature) {
    switch (feature) {
        case Feature::level_refined:
        case Feature::level_certified:
            if (device.shader_float64) return {feature, Support::native, ""};
            return {feature, Support::unsupported, "the device has no float64"};
        case Feature::compaction: return {feature, Support::native, "its arrays have their exact size when built"};
        default: return {feature, Support::native, ""};
    }
}

void SwTlas::save(const std::filesystem::path& file) const { backend().save(file); }

SwTlas::Loaded SwTlas::load(Context& context, const std::filesystem::path& file) {
    DecodedSave saved = decode_save(read_file(file), file.string());
    Loaded loaded{std::make_unique<SwTlas>(context, AccelOptions{.layout = saved.layout}), {}};
    Commands commands(context, "SwTlas load");
    for (SavedGeometry& geometry : saved.geometries)
        loaded.handles.push_back(loaded.accel->backend().push_saved(commands, std::move(geometry)));
    commands.submit();
    return loaded;
}

BuiltTree download_geometry(const SwTlas& accel, AccelHandle handle) {
    return accel.backend().download_geometry(handle);
}
BuiltTree download_scene(const SwTlas& accel) { return accel.backend().download_scene(); }

void SwBackend::save(const std::filesystem::path& file) const {
    check_synced("save");
    std::vector<SavedGeometry> geometries;
    for (const AccelHandle handle : handles()) {
        BuiltTree tree = download_geometry(handle);
        tree.bvh.nodes = {};
        std::vector<InstanceRecord> instances;
        for (const InstanceState& state : get_instances(handle))
            instances.push_back(make_instance_record(state.transform, state.options));
        Geometry mesh = geometry(handle);
        const float scale = mesh.scale;
        mesh.positions = mesh.built_positions();
        mesh.scale = 1;
        name_vertices(tree.records, mesh.triangles);
        geometries.push_back({std::move(mesh), tree.bvh, std::move(tree.nodes), std::move(tree.triangles),
                              std::move(tree.records), std::move(instances), scale});
    }
    const EncodedSave encoded = encode_save(options().layout, geometries);
    std::vector<std::span<const std::byte>> regions = {encoded.head};
    regions.insert(regions.end(), encoded.body.begin(), encoded.body.end());
    write_file(file, regions);
}

AccelHandle SwBackend::push_saved(Commands& commands, SavedGeometry&& saved) {
    Buffer block(context(), {.name = "geometry block", .bytes = geometry_block_bytes});
    if (!saved.mesh.leaves.empty()) saved.mesh.welded = weld(saved.mesh.positions, saved.mesh.triangles);
    const HostMesh mesh(saved.mesh);
    name_vertices(saved.records, mesh.triangles);
    auto built = std::make_unique<SwBuiltGeometry>(context(), saved.mesh, false, options().layout);
    SwGeometry written = block_of(*built, built->vertices(), saved.mesh.kind);
    saved.bvh.nodes = written.bvh.nodes;
    written.bvh = saved.bvh;
    {
        const auto pass = commands.pass("swtlas load");
        commands.write(block, written);
        const Commands::Region regions[] = {
            {built->layout.nodes, std::as_bytes(std::span(saved.nodes))},
            {built->layout.triangles, std::as_bytes(std::span(saved.leaves))},
            {built->layout.records, std::as_bytes(std::span(saved.records))},
            {built->layout.vertices, std::as_bytes(mesh.positions.first(built->layout.vertex_count))}};
        commands.upload_regions(built->buffer, regions);
    }
    saved.mesh.welded = {};
    saved.mesh.positions = times(saved.mesh.positions, saved.scale);
    saved.mesh.scale = saved.scale;
    return push_built(std::move(saved.mesh), std::move(block), std::move(built), saved.instances);
}

}  // namespace twinray
