// SPDX-License-Identifier: MIT
// Saving what SwTlas has built, and taking it up again.
#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "swtlas/built.h"
#include "swtlas/saved.h"

namespace twinray {

void SwBackend::save(const std::filesystem::path& file) const {
    check_synced("save");
    std::vector<SavedGeometry> geometries;
    for (const AccelHandle handle : handles()) {
        BuiltTree tree = download_geometry(handle);
        tree.bvh.nodes = {};
        std::vector<InstanceRecord> instances;
        for (const InstanceState& state : get_instances(handle))
            instances.push_back(make_instance_record(state.transform, state.options));
        geometries.push_back({geometry(handle), tree.bvh, std::move(tree.nodes), std::move(tree.triangles),
                              std::move(tree.records), std::move(instances)});
    }
    const EncodedSave encoded = encode_save(options().layout, geometries);
    std::vector<std::span<const std::byte>> regions = {encoded.head};
    regions.insert(regions.end(), encoded.body.begin(), encoded.body.end());
    write_file(file, regions);
}

AccelHandle SwBackend::push_saved(Commands& commands, SavedGeometry&& saved) {
    Buffer block(context(), {.name = "geometry block", .bytes = geometry_block_bytes});
    auto built = std::make_unique<SwBuiltGeometry>(context(), saved.mesh, false, options().layout);
    SwGeometry written = block_of(*built, built->vertices(), saved.mesh.kind);
    saved.bvh.nodes = written.bvh.nodes;
    written.bvh = saved.bvh;
    {
        const auto pass = commands.pass("swtlas load");
        commands.write(block, written);
        const auto vertices = std::span(saved.mesh.positions).first(built->layout.vertex_count);
        const Commands::Region regions[] = {{built->layout.nodes, std::as_bytes(std::span(saved.nodes))},
                                            {built->layout.triangles, std::as_bytes(std::span(saved.leaves))},
                                            {built->layout.records, std::as_bytes(std::span(saved.records))},
                                            {built->layout.vertices, std::as_bytes(vertices)}};
        commands.upload_regions(built->buffer, regions);
    }
    return push_built(std::move(saved.mesh), std::move(block), std::move(built), saved.instances);
}

}  // namespace twinray
