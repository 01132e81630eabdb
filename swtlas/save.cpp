// SPDX-License-Identifier: MIT
// Saving what SwTlas has built, and taking it up again.
#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "swtlas/built.h"
#include "swtlas/plan.h"
#include "swtlas/saved.h"
#include "swtlas/sw_tlas.h"

namespace twinray {

void SwTlas::save(const std::filesystem::path& file) const {
    check_synced("save");
    std::vector<SavedGeometry> geometries;
    for (const AccelHandle handle : handles()) {
        Tree tree = download_geometry(handle);
        tree.bvh.nodes = {};
        std::vector<InstanceRecord> records;
        for (const InstanceState& state : get_instances(handle))
            records.push_back(make_instance_record(state.transform, state.options));
        geometries.push_back(
            {geometry(handle), tree.bvh, std::move(tree.nodes), std::move(tree.triangles), std::move(records)});
    }
    const EncodedSave encoded = encode_save(geometries);
    std::vector<std::span<const std::byte>> pieces = {encoded.head};
    pieces.insert(pieces.end(), encoded.body.begin(), encoded.body.end());
    write_file(file, pieces);
}

SwTlas::Loaded SwTlas::load(Context& context, const std::filesystem::path& file) {
    std::vector<SavedGeometry> geometries = decode_save(read_file(file), file.string());
    Loaded loaded{std::make_unique<SwTlas>(context), {}};
    Commands commands(context, "SwTlas load");
    for (SavedGeometry& geometry : geometries)
        loaded.handles.push_back(loaded.accel->push_saved(commands, std::move(geometry)));
    commands.submit();
    return loaded;
}

AccelHandle SwTlas::push_saved(Commands& commands, SavedGeometry&& saved) {
    Buffer block(context(), {.name = "geometry block", .bytes = geometry_block_bytes});
    auto built = std::make_unique<SwBuiltGeometry>(context(), saved.mesh, options().layout);
    saved.bvh.nodes = built->nodes();
    {
        const auto pass = commands.pass("swtlas load");
        commands.write(block, SwGeometry{saved.bvh, built->triangles(), built->records(), saved.mesh.kind, 0});
        const Commands::Piece pieces[] = {{built->layout.nodes, std::as_bytes(std::span(saved.nodes))},
                                          {built->layout.triangles, std::as_bytes(std::span(saved.leaves))}};
        commands.upload_pieces(built->buffer, pieces);
    }
    const auto count = static_cast<uint>(saved.leaves.size());
    const BuildPlan plan = plan_build(std::span(&count, 1));
    const BuildTree tree{0, count, {}, {}, built->triangles(), {block.address()}, built->records()};
    Buffer scratch(context(), {.name = "swtlas load scratch", .bytes = plan.scratch.bytes});
    builder_.record_collapse(commands, plan, std::span(&tree, 1), scratch);
    commands.keep(std::move(scratch));
    return push_built(std::move(saved.mesh), std::move(block), std::move(built), saved.records);
}

}  // namespace twinray
