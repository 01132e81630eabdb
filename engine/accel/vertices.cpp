// SPDX-License-Identifier: MIT
#include "engine/accel/vertices.h"

#include <utility>

#include "engine/core/device_list.h"
#include "engine/scene/mesh.h"
#include "engine_copy_floats.spv.h"

namespace twinray {
namespace {

VertexSlice make_arrays(Context& context, const Geometry& geometry) {
    VertexSlice made;
    made.positions = Buffer(
        context, {.name = "vertices of '" + geometry.name + "'", .bytes = geometry.vertex_count() * sizeof(vec3)});
    made.indices = Buffer(
        context, {.name = "indices of '" + geometry.name + "'", .bytes = geometry.triangle_count() * sizeof(uvec3)});
    return made;
}

VertexSlice make_lacking(Context& context, const VertexArrays::Item& item) {
    VertexSlice made = item.slice->on_device() ? VertexSlice{} : make_arrays(context, *item.geometry);
    if (item.slice->costs.bytes() == 0) made.costs = CostLog(context);
    return made;
}

MeshGather::Item gather_item(const Geometry& geometry, const PackedMesh& target) {
    return {&*geometry.device, geometry.name, geometry.scale, target};
}

}  // namespace

VertexArrays::VertexArrays(Context& context)
    : context_(context),
      gather_(context),
      copy_floats_(context, lazy_kernel("engine_copy_floats", engine_copy_floats_spirv)) {}

VertexArrays::Staged VertexArrays::stage(Commands& commands, std::vector<Item> items) const {
    Staged staged;
    staged.items = std::move(items);
    if (staged.items.empty()) return staged;
    std::vector<MeshGather::Item> gathers;
    for (std::size_t i = 0; i < staged.items.size(); ++i) {
        const auto& [geometry, slice] = staged.items[i];
        staged.item_of.emplace(slice, i);
        staged.made.push_back(make_lacking(context_, staged.items[i]));
        if (slice->gathers) gathers.push_back(gather_item(*geometry, staged.mesh(i)));
    }
    staged.faults = gather_.record(commands, gathers);
    record_positions(commands, staged);
    return staged;
}

void VertexArrays::record_positions(Commands& commands, const Staged& staged) const {
    const auto pass = commands.pass("vertices");
    for (std::size_t i = 0; i < staged.items.size(); ++i) {
        const auto& [geometry, slice] = staged.items[i];
        if (staged.made[i].on_device() && !slice->gathers)
            commands.upload(staged.made[i].indices, std::span(geometry->triangles));
        const auto count = static_cast<uint>(3 * geometry->vertex_count());
        if (slice->incoming.address)
            copy_floats_.dispatch(commands, {slice->incoming, staged.mesh(i).positions, count, 1 / geometry->scale},
                                  count);
        else if (!slice->device_wrote)
            commands.upload(slice->on_device() ? slice->positions : staged.made[i].positions,
                            std::span(geometry->positions));
    }
}

PackedMesh VertexArrays::Staged::mesh_of(const VertexSlice& slice) const {
    const auto found = item_of.find(&slice);
    return found == item_of.end() ? slice.mesh() : mesh(found->second);
}

CostTarget VertexArrays::Staged::cost_target(std::size_t item) const {
    const CostLog& made_costs = made[item].costs;
    return made_costs.bytes() ? made_costs.target() : items[item].slice->costs.target();
}

void VertexArrays::Staged::retain_temporaries(Commands& commands) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (!items[i].geometry->is_in_place()) continue;
        commands.retain(std::exchange(made[i].positions, {}));
        commands.retain(std::exchange(made[i].indices, {}));
    }
}

std::vector<VertexSlice*> VertexArrays::commit(Staged&& staged, SyncPoint done) {
    gather_.commit(std::move(staged.faults), done);
    std::vector<VertexSlice*> slices;
    for (std::size_t i = 0; i < staged.items.size(); ++i) {
        VertexSlice& slice = *staged.items[i].slice;
        VertexSlice& made = staged.made[i];
        if (made.costs.bytes()) slice.costs = std::move(made.costs);
        if (made.on_device()) {
            slice.positions = std::move(made.positions);
            slice.indices = std::move(made.indices);
        }
        slice.device_wrote |= slice.incoming.address != 0;
        slice.edited = slice.gathers = slice.rebuilds = false;
        slice.incoming = {};
        slices.push_back(&slice);
    }
    return slices;
}

void VertexArrays::download(Geometry& geometry, const VertexSlice& slice) const {
    if (!geometry.device && !slice.device_wrote) return;
    VertexSlice read;  // of the caller's memory, where there is no copy
    if (!slice.on_device()) {
        read = make_arrays(context_, geometry);
        Commands commands(context_, "read mesh");
        const MeshGather::Item item = gather_item(geometry, read.mesh());
        const MeshGather::Faults faults = gather_.record(commands, std::span(&item, 1));
        commands.submit();
    }
    const VertexSlice& from = slice.on_device() ? slice : read;
    if (slice.device_wrote)
        geometry.positions = twinray::download<vec3>(context_, from.positions, geometry.vertex_count());
    if (geometry.device)
        geometry.triangles = twinray::download<uvec3>(context_, from.indices, geometry.triangle_count());
    geometry.device.reset();
    geometry.non_finite_triangles = count_non_finite_triangles({geometry.name, geometry.positions, geometry.triangles});
}

}  // namespace twinray
