// SPDX-License-Identifier: MIT
#include "engine/accel/vertices.h"

#include <utility>

#include "engine_copy_floats.spv.h"

namespace twinray {
namespace {

VertexSlice make_buffers(Context& context, const Geometry& geometry) {
    VertexSlice made;
    made.positions = Buffer(
        context, {.name = "vertices of '" + geometry.name + "'", .bytes = std::span(geometry.positions).size_bytes()});
    made.indices = Buffer(
        context, {.name = "indices of '" + geometry.name + "'", .bytes = std::span(geometry.triangles).size_bytes()});
    made.costs = CostLog(context);
    return made;
}

}  // namespace

VertexArrays::VertexArrays(Context& context)
    : context_(context), copy_floats_(context, {.name = "engine_copy_floats", .spirv = engine_copy_floats_spirv}) {}

VertexArrays::Staged VertexArrays::stage(Commands& commands, std::vector<Item> items) const {
    Staged staged;
    staged.items = std::move(items);
    if (staged.items.empty()) return staged;
    const auto pass = commands.pass("vertices");
    for (std::size_t i = 0; i < staged.items.size(); ++i) {
        const auto& [geometry, slice] = staged.items[i];
        staged.item_of.emplace(slice, i);
        staged.made.push_back(slice->on_device() ? VertexSlice{} : make_buffers(context_, *geometry));
        if (!slice->on_device()) commands.upload(staged.made[i].indices, std::span(geometry->triangles));
        const auto count = static_cast<uint>(3 * geometry->positions.size());
        if (slice->incoming.address)
            copy_floats_.dispatch(commands, {slice->incoming, staged.mesh(i).positions, count, 1 / geometry->scale},
                                  count);
        else
            commands.upload(slice->on_device() ? slice->positions : staged.made[i].positions,
                            std::span(geometry->positions));
    }
    return staged;
}

DeviceMesh VertexArrays::Staged::mesh_of(const VertexSlice& slice) const {
    const auto found = item_of.find(&slice);
    return found == item_of.end() ? slice.mesh() : mesh(found->second);
}

std::vector<VertexSlice*> VertexArrays::commit(Staged&& staged) {
    std::vector<VertexSlice*> slices;
    for (std::size_t i = 0; i < staged.items.size(); ++i) {
        VertexSlice& slice = *staged.items[i].slice;
        const bool incoming = slice.incoming.address != 0;
        if (!slice.on_device()) slice = std::move(staged.made[i]);
        slice.device_wrote = incoming;
        slice.edited = false;
        slice.incoming = {};
        slices.push_back(&slice);
    }
    return slices;
}

}  // namespace twinray
