#include "engine/collide/triangle_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "collide_world_triangles.spv.h"
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

// Returns null for an empty array.
Uints address_of(std::span<const uint> values) {
    return {values.empty() ? 0 : reinterpret_cast<std::uint64_t>(values.data())};
}

// Returns the meshes of the instances, ascending, each once.
std::vector<uint> meshes_of(const PlacedMeshes& placed, std::span<const uint> instances) {
    std::set<uint> meshes;
    for (const uint instance : instances) meshes.insert(placed.instances[instance].mesh);
    return {meshes.begin(), meshes.end()};
}

TriangleRun make_run(const MeshOnDevice& on_device, Uints vertex_ids, const Transform& transform, std::size_t first) {
    return {{{transform.rows[0], transform.rows[1], transform.rows[2]}, on_device.mesh},
            vertex_ids,
            static_cast<uint>(first),
            determinant(transform) < 0 ? 1u : 0u,
            on_device.scale,
            0};
}

MeshOnDevice on_host(const MeshView& mesh) {
    return {{},
            {{reinterpret_cast<std::uint64_t>(mesh.positions.data())},
             {reinterpret_cast<std::uint64_t>(mesh.triangles.data())}},
            1};
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

void TriangleSet::set(const PlacedMeshes& placed, std::span<const uint> chosen, SharedVertices shared) {
    clear();
    std::uint64_t total = 0;
    for (const uint index : chosen) total += placed.mesh_of(index).triangles.size();
    if (total > BoxTree::max_count)
        fail("the instances in question have ", total, " triangles; at most ", BoxTree::max_count, " fit");
    vertex_ids_.resize(placed.meshes.size());
    if (total == 0) return;
    const std::vector<uint> used = meshes_of(placed, chosen);
    if (shared == SharedVertices::by_position)
        for (const uint mesh : used) vertex_ids_[mesh] = ids_by_position(placed.meshes[mesh].positions);
    Commands commands(context_, "collide meshes");
    std::vector<MeshOnDevice> on_device = placed.on_device(commands, used);
    const std::vector<Uints> ids = upload_vertex_ids(commands);
    std::vector<TriangleRun> runs, table;
    std::size_t count = 0;
    for (const uint index : chosen) {
        const auto& [mesh, transform] = placed.instances[index];
        const auto place = static_cast<std::size_t>(std::ranges::lower_bound(used, mesh) - used.begin());
        table.push_back(make_run(on_device[place], ids[mesh], transform, count));
        runs.push_back(make_run(on_host(placed.meshes[mesh]), address_of(vertex_ids_[mesh]), transform, count));
        count += placed.meshes[mesh].triangles.size();
    }
    table_ = Buffer(context_, {.name = "collide runs", .bytes = table.size() * sizeof(TriangleRun)});
    world_triangles_ = Buffer(context_, {.name = "collide triangles", .bytes = count * sizeof(WorldTriangle)});
    names_ = Buffer(context_, {.name = "collide names", .bytes = count * sizeof(TriangleName)});
    {
        const auto pass = commands.pass("collide runs");
        commands.upload(table_, std::span<const TriangleRun>(table));
    }
    commands.submit();
    chosen_.assign(chosen.begin(), chosen.end());
    runs_ = std::move(runs);
    meshes_ = std::move(on_device);
    count_ = count;
}

// It is empty then, until set() has done everything.
void TriangleSet::clear() {
    count_ = 0;
    runs_.clear();
    chosen_.clear();
    meshes_.clear();
    vertex_ids_.clear();
}

// Returns where they are, by mesh; absent where vertices are not shared by position.
std::vector<Uints> TriangleSet::upload_vertex_ids(Commands& commands) {
    std::vector<Uints> addresses(vertex_ids_.size(), {context_.absent()});
    std::vector<Commands::Region> regions;
    std::uint64_t bytes = 0;
    for (const std::vector<uint>& ids : vertex_ids_) {
        regions.push_back({bytes, std::as_bytes(std::span(ids))});
        bytes += regions.back().data.size();
    }
    vertex_ids_on_device_ = Buffer(context_, {.name = "collide vertex ids", .bytes = bytes});
    if (bytes == 0) return addresses;
    const auto pass = commands.pass("collide vertex ids");
    commands.upload_regions(vertex_ids_on_device_, regions);
    for (std::size_t mesh = 0; mesh < regions.size(); ++mesh)
        if (!regions[mesh].data.empty()) addresses[mesh] = vertex_ids_on_device_.ref<uint>(regions[mesh].offset);
    return addresses;
}

void TriangleSet::build(BoxTree& tree) {
    Commands commands(context_, "collide triangles");
    const WorldTrianglesArgs args{table_.ref<TriangleRun>(),
                                  tree.prepare(count_),
                                  world_triangles_.ref<WorldTriangle>(),
                                  names_.ref<TriangleName>(),
                                  static_cast<uint>(runs_.size()),
                                  static_cast<uint>(count_)};
    if (count_ != 0) kernel_.dispatch(commands, args, count_);
    tree.record(commands);
    commands.submit();
    meshes_.clear();
}

std::size_t TriangleSet::run_of(uint item) const {
    const auto after = std::upper_bound(runs_.begin(), runs_.end(), item,
                                        [](uint i, const TriangleRun& run) { return i < run.first_triangle; });
    return static_cast<std::size_t>(after - runs_.begin()) - 1;
}

WorldTriangle TriangleSet::triangle(uint item) const {
    return world_triangle(runs_[run_of(item)], indices_of(runs_[run_of(item)], primitive(item)));
}

TriangleName TriangleSet::name(uint item) const {
    const std::size_t index = run_of(item);
    const TriangleRun& run = runs_[index];
    uvec3 ids = indices_of(run, primitive(item));
    if (run.vertex_ids.address) ids = {run.vertex_ids[ids.x], run.vertex_ids[ids.y], run.vertex_ids[ids.z]};
    return {ids, static_cast<uint>(index)};
}

}  // namespace twinray
