// SPDX-License-Identifier: MIT
#include "engine/collide/triangle_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "collide_world_triangles.spv.h"
#include "engine/collide/box_tree.h"
#include "engine/core/error.h"

namespace twinray {
namespace {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/world_vertex.h"
#include "twinray/glsl/cpp_end.h"

// Returns a bound below the least coordinate of the box under a row, with room for float64 rounding.
double least_coordinate(const vec4& row, const Bounds& box) {
    double sum = row.w, size = std::abs(double{row.w});
    for (int axis = 0; axis < 3; ++axis) {
        const double factor = row[axis];
        sum += std::min(factor * box.lo[axis], factor * box.hi[axis]);
        size += std::max(std::abs(factor * box.lo[axis]), std::abs(factor * box.hi[axis]));
    }
    return sum - size * 0x1p-48;
}

// Returns for each vertex the first one at its position.
std::vector<uint> ids_by_position(std::span<const vec3> positions) {
    const auto is_before = [&](uint a, uint b) {
        const vec3 p = positions[a], q = positions[b];
        if (p.x != q.x) return p.x < q.x;
        if (p.y != q.y) return p.y < q.y;
        return p.z != q.z ? p.z < q.z : a < b;
    };
    std::vector<uint> order, ids(positions.size());
    std::iota(ids.begin(), ids.end(), 0u);
    for (const uint i : ids)
        if (is_finite(positions[i])) order.push_back(i);
    std::sort(order.begin(), order.end(), is_before);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (positions[order[i]] == positions[order[i - 1]]) ids[order[i]] = ids[order[i - 1]];
    return ids;
}

// The data of a mesh for the device, one after the other.
struct Upload {
    std::vector<Commands::Region> regions;
    std::uint64_t bytes = 0;

    template <class T>
    std::uint64_t add(std::span<const T> values) {
        const std::uint64_t at = bytes;
        if (!values.empty()) regions.push_back({at, std::as_bytes(values)});
        bytes += values.size_bytes();
        return at;
    }
};

// Addresses are offsets in the uploaded data.
InstancedMesh added_to(Upload& upload, const MeshView& mesh, std::span<const uint> ids) {
    InstancedMesh added{};
    added.positions.address = upload.add(mesh.positions);
    added.indices.address = upload.add(mesh.triangles);
    added.vertex_ids.address = upload.add(ids);
    return added;
}

void move_to(const Context& context, std::uint64_t address, InstancedMesh& mesh, SharedVertices shared) {
    mesh.positions.address += address;
    mesh.indices.address += address;
    mesh.vertex_ids.address = shared == SharedVertices::by_index ? context.absent() : mesh.vertex_ids.address + address;
}

InstancedMesh on_host(const MeshView& mesh, std::span<const uint> ids) {
    InstancedMesh host{};
    host.positions = {reinterpret_cast<std::uint64_t>(mesh.positions.data())};
    host.indices = {reinterpret_cast<std::uint64_t>(mesh.triangles.data())};
    host.vertex_ids = {reinterpret_cast<std::uint64_t>(ids.data())};
    return host;
}

InstancedMesh instanced(InstancedMesh mesh, const Transform& transform, std::size_t first_triangle) {
    mesh.object_to_world = {transform.rows[0], transform.rows[1], transform.rows[2]};
    mesh.first_triangle = static_cast<uint>(first_triangle);
    mesh.is_mirrored = determinant(transform) < 0 ? 1 : 0;
    return mesh;
}

}  // namespace

void check_instances(std::span<const MeshView> meshes, std::span<const MeshInstance> instances, const char* action) {
    for (const MeshView& mesh : meshes) check_indices(mesh);
    for (std::size_t i = 0; i < instances.size(); ++i)
        if (instances[i].mesh >= meshes.size())
            fail(action, ": instance ", i, " is of mesh ", instances[i].mesh, " of ", meshes.size());
}

TreeBox box_of_instance(const Bounds& mesh, const Transform& transform, uint item) {
    TreeBox box = empty_tree_box();
    if (mesh.is_empty()) return box;
    for (int axis = 0; axis < 3; ++axis) {
        const vec4 row = transform.rows[static_cast<std::size_t>(axis)];
        box.min[axis] = float_below(least_coordinate(row, mesh));
        box.max[axis] = -float_below(least_coordinate(-row, mesh));
    }
    box.item = box.group = item;
    return box;
}

TriangleSet::TriangleSet(Context& context)
    : context_(context),
      kernel_(context, {.name = "collide_world_triangles", .spirv = collide_world_triangles_spirv}) {}

void TriangleSet::set(std::span<const MeshView> meshes, std::span<const MeshInstance> instances,
                      std::span<const uint> chosen, SharedVertices shared) {
    count_ = 0;
    std::uint64_t total = 0;
    for (const uint index : chosen) total += meshes[instances[index].mesh].triangles.size();
    if (total > BoxTree::max_count)
        fail("the instances in question have ", total, " triangles; at most ", BoxTree::max_count, " fit");
    instanced_.clear();
    vertex_ids_.assign(meshes.size(), {});
    chosen_.assign(chosen.begin(), chosen.end());
    Upload upload;
    std::vector<std::optional<InstancedMesh>> uploaded(meshes.size());
    std::vector<InstancedMesh> table;
    for (const uint index : chosen) {
        const MeshInstance& instance = instances[index];
        const MeshView& mesh = meshes[instance.mesh];
        std::vector<uint>& ids = vertex_ids_[instance.mesh];
        std::optional<InstancedMesh>& of_mesh = uploaded[instance.mesh];
        if (!of_mesh) {
            if (shared == SharedVertices::by_position) ids = ids_by_position(mesh.positions);
            of_mesh = added_to(upload, mesh, ids);
        }
        table.push_back(instanced(*of_mesh, instance.transform, count_));
        instanced_.push_back(instanced(on_host(mesh, ids), instance.transform, count_));
        count_ += mesh.triangles.size();
    }
    if (count_ == 0) return;
    allocate(upload.bytes);
    for (InstancedMesh& mesh : table) move_to(context_, data_.address(), mesh, shared);
    Commands commands(context_, "collide meshes");
    {
        const auto pass = commands.pass("collide meshes");
        commands.upload_regions(data_, upload.regions);
        commands.upload(table_, std::span<const InstancedMesh>(table));
    }
    commands.submit();
}

void TriangleSet::allocate(std::uint64_t mesh_bytes) {
    data_ = Buffer(context_, {.name = "collide meshes", .bytes = mesh_bytes});
    table_ = Buffer(context_, {.name = "collide instanced meshes", .bytes = instanced_.size() * sizeof(InstancedMesh)});
    world_triangles_ = Buffer(context_, {.name = "collide triangles", .bytes = count_ * sizeof(WorldTriangle)});
    names_ = Buffer(context_, {.name = "collide names", .bytes = count_ * sizeof(TriangleName)});
}

void TriangleSet::record(Commands& commands, Ref<TreeBox> boxes) const {
    if (count_ == 0) return;
    const WorldTrianglesArgs args{table_.ref<InstancedMesh>(),           boxes,
                                  world_triangles_.ref<WorldTriangle>(), names_.ref<TriangleName>(),
                                  static_cast<uint>(instanced_.size()),  static_cast<uint>(count_)};
    kernel_.dispatch(commands, args, count_);
}

std::size_t TriangleSet::mesh_of(uint item) const {
    const auto after = std::upper_bound(instanced_.begin(), instanced_.end(), item,
                                        [](uint i, const InstancedMesh& mesh) { return i < mesh.first_triangle; });
    return static_cast<std::size_t>(after - instanced_.begin()) - 1;
}

WorldTriangle TriangleSet::triangle(uint item) const {
    return world_triangle(instanced_[mesh_of(item)], indices_of(instanced_[mesh_of(item)], primitive(item)));
}

TriangleName TriangleSet::name(uint item) const {
    const std::size_t index = mesh_of(item);
    const InstancedMesh& mesh = instanced_[index];
    uvec3 ids = indices_of(mesh, primitive(item));
    if (mesh.vertex_ids.address) ids = {mesh.vertex_ids[ids.x], mesh.vertex_ids[ids.y], mesh.vertex_ids[ids.z]};
    return {ids, static_cast<uint>(index)};
}

}  // namespace twinray
