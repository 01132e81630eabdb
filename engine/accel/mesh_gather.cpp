#include "engine/accel/mesh_gather.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "engine/core/error.h"
#include "engine_gather_mesh.spv.h"

namespace twinray {
namespace {

constexpr std::size_t max_vertices = ~0u / 3;  // a kernel counts their floats

constexpr std::uint64_t index_bytes(IndexFormat format) { return format == IndexFormat::uint16 ? 2 : 4; }

void check_address(const DeviceMesh& mesh, const char* what, std::uint64_t address, std::uint64_t alignment) {
    if (address == 0 || address % alignment != 0)
        fail("mesh '", mesh.name, "': device address ", address, " of its ", what, " must be a multiple of ", alignment,
             " and not 0");
}

void check_indices_of(const DeviceMesh& mesh) {
    if (mesh.index_format != IndexFormat::none)
        return check_address(mesh, "indices", mesh.indices, index_bytes(mesh.index_format));
    if (mesh.indices != 0) fail("mesh '", mesh.name, "': indices without an index format");
    if (mesh.vertex_count / 3 < mesh.triangle_count)
        fail("mesh '", mesh.name, "': ", mesh.vertex_count, " vertices for ", mesh.triangle_count,
             " triangles without indices, which take three each");
}

}  // namespace

void check_device_mesh(const DeviceMesh& mesh) {
    if (mesh.triangle_count > Geometry::max_primitives)
        fail("mesh '", mesh.name, "': ", mesh.triangle_count, " triangles; at most ", Geometry::max_primitives,
             " fit in one geometry");
    if (mesh.vertex_count == 0 || mesh.vertex_count > max_vertices)
        fail("mesh '", mesh.name, "': ", mesh.vertex_count, " vertices; 1 to ", max_vertices, " fit");
    const std::uint32_t component = component_bytes(mesh.format);
    check_address(mesh, "positions", mesh.positions, component);
    if (mesh.stride < 3 * component || mesh.stride % component != 0)
        fail("mesh '", mesh.name, "': stride ", mesh.stride, " must be a multiple of ", component, " and at least ",
             3 * component);
    check_indices_of(mesh);
    if (mesh.count_on_device.address % 4 != 0)
        fail("mesh '", mesh.name, "': device address ", std::uint64_t{mesh.count_on_device.address},
             " of its count must be a multiple of 4");
    if (mesh.bounds && (mesh.bounds->is_empty() || !is_finite(mesh.bounds->lo) || !is_finite(mesh.bounds->hi)))
        fail("mesh '", mesh.name, "': its bounds must be finite and not empty");
}

bool is_packed(const DeviceMesh& mesh) {
    return mesh.format == VertexFormat::float32 && mesh.stride == 12 && mesh.index_format == IndexFormat::uint32;
}

MeshGather::MeshGather(Context& context)
    : context_(context), kernel_(context, lazy_kernel("engine_gather_mesh", engine_gather_mesh_spirv)) {}

MeshGather::Faults MeshGather::record(Commands& commands, std::span<const Item> items) const {
    Faults faults;
    if (items.empty()) return faults;
    const std::uint64_t bytes = items.size() * sizeof(uint);
    Buffer counting(context_, {.name = "faulty triangles", .bytes = bytes});
    faults.counts = Buffer(context_, {.name = "faulty triangles readback", .bytes = bytes, .memory = Memory::readback});
    {
        const auto pass = commands.pass("meshes in device memory");
        commands.fill(counting, 0, bytes, 0);
    }
    {
        const auto pass = commands.pass(kernel_.name());
        for (std::size_t i = 0; i < items.size(); ++i) {
            const DeviceMesh& mesh = *items[i].mesh;
            faults.names.push_back(items[i].name);
            kernel_.dispatch(commands,
                             {mesh.positions, mesh.indices, mesh.count_on_device, items[i].target.positions,
                              items[i].target.indices, counting.ref<uint>(i * sizeof(uint)),
                              static_cast<uint>(mesh.vertex_count), static_cast<uint>(mesh.triangle_count), mesh.stride,
                              static_cast<uint>(mesh.format), static_cast<uint>(mesh.index_format), 1 / items[i].scale},
                             std::max(mesh.vertex_count, mesh.triangle_count));
        }
    }
    const auto pass = commands.pass("faulty triangles");
    commands.copy(counting, 0, faults.counts, 0, bytes);
    commands.retain(std::move(counting));
    return faults;
}

void MeshGather::commit(Faults&& faults, SyncPoint done) {
    if (!faults.names.empty()) untold_.emplace_back(done, std::move(faults));
}

void MeshGather::warn_of_faults(const std::string& accel) {
    std::erase_if(untold_, [&](const auto& sync) {
        const auto& [done, faults] = sync;
        if (!context_.is_reached(done)) return false;
        std::vector<uint> counts(faults.names.size());
        std::memcpy(counts.data(), faults.counts.mapped(), counts.size() * sizeof(uint));
        std::map<std::string, uint> by_name;
        for (std::size_t i = 0; i < counts.size(); ++i) by_name[faults.names[i]] += counts[i];
        for (const auto& [name, count] : by_name)
            if (uint& told = told_[name]; std::exchange(told, count) != count && count != 0)
                context_.state().warn(text(accel, ": mesh '", name, "': ", count,
                                           " triangles name a vertex that it lacks; they are inactive"));
        return true;
    });
}

}  // namespace twinray
