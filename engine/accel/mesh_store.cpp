#include "engine/accel/mesh_store.h"

#include <set>
#include <utility>

#include "engine/accel/batches.h"
#include "engine/core/device_list.h"
#include "engine/scene/mesh.h"
#include "engine_copy_floats.spv.h"

namespace twinray {
namespace {

// Describes a mesh that lies at this offset: positions, then triangles.
MeshOnDevice mesh_in(const std::shared_ptr<Buffer>& buffer, std::uint64_t offset, std::size_t vertices, float scale) {
    return {buffer, {buffer->ref<float>(offset), buffer->ref<uint>(offset + vertices * sizeof(vec3))}, scale};
}

MeshGather::Item gather_item(const Geometry& geometry, const PackedMesh& target) {
    return {&*geometry.device, geometry.name, geometry.scale, target};
}

constexpr std::uint64_t most_bytes = 1 << 30;  // of a buffer of several meshes

std::uint64_t triangles_at(const Geometry& geometry) { return geometry.vertex_count() * sizeof(vec3); }

std::uint64_t bytes_of(const MeshView& mesh) { return mesh.positions.size_bytes() + mesh.triangles.size_bytes(); }

// Appends them, in one buffer.
void upload_run(Commands& commands, std::span<const MeshView> meshes, std::vector<MeshOnDevice>& uploaded) {
    std::uint64_t bytes = 0;
    for (const MeshView& mesh : meshes) bytes += bytes_of(mesh);
    if (bytes == 0) return uploaded.resize(uploaded.size() + meshes.size());
    const auto buffer = std::make_shared<Buffer>(commands.context(), BufferDesc{.name = "meshes", .bytes = bytes});
    MeshUpload upload(*buffer);
    for (const MeshView& mesh : meshes) uploaded.push_back({buffer, upload.add(mesh.positions, mesh.triangles)});
    upload.record(commands);
}

}  // namespace

std::uint64_t MeshUpload::add(std::span<const std::byte> array) {
    regions_.push_back({next_, array});
    next_ += array.size();
    return target_.address() + regions_.back().offset;
}

PackedMesh MeshUpload::add(std::span<const vec3> positions, std::span<const uvec3> triangles) {
    PackedMesh mesh;
    mesh.positions.address = add(std::as_bytes(positions));
    mesh.indices.address = add(std::as_bytes(triangles));
    return mesh;
}

std::vector<MeshOnDevice> upload_meshes(Commands& commands, std::span<const MeshView> meshes) {
    std::vector<std::uint64_t> bytes;
    for (const MeshView& mesh : meshes) bytes.push_back(bytes_of(mesh));
    std::vector<MeshOnDevice> uploaded;
    const auto pass = commands.pass("meshes");
    for (const Batches::Run& run : cut_into_batches(bytes, most_bytes).runs)
        upload_run(commands, meshes.subspan(run.first, run.count), uploaded);
    return uploaded;
}

std::uint64_t bytes_of(std::span<const MeshOnDevice> meshes) {
    std::set<const Buffer*> counted;
    std::uint64_t bytes = 0;
    for (const MeshOnDevice& mesh : meshes)
        if (mesh && counted.insert(mesh.buffer.get()).second) bytes += mesh.buffer->bytes();
    return bytes;
}

MeshStore::MeshStore(Context& context)
    : context_(context),
      gather_(context),
      copy_floats_(context, lazy_kernel("engine_copy_floats", engine_copy_floats_spirv)) {}

MeshOnDevice MeshStore::make_copy(const Geometry& geometry) const {
    const auto buffer = std::make_shared<Buffer>(
        context_, BufferDesc{.name = "mesh '" + geometry.name + "'",
                             .bytes = triangles_at(geometry) + geometry.triangle_count() * sizeof(uvec3)});
    return mesh_in(buffer, 0, geometry.vertex_count(), geometry.scale);
}

MeshStore::Staged MeshStore::stage(Commands& commands, std::vector<Item> items) const {
    Staged staged;
    staged.items = std::move(items);
    if (staged.items.empty()) return staged;
    std::vector<MeshGather::Item> gathers;
    for (std::size_t i = 0; i < staged.items.size(); ++i) {
        const auto& [geometry, stored] = staged.items[i];
        staged.item_of.emplace(stored, i);
        staged.made.push_back(stored->on_device() ? MeshOnDevice{} : make_copy(*geometry));
        staged.costs.push_back(stored->costs.bytes() == 0 ? CostLog(context_) : CostLog{});
        if (stored->gathers) gathers.push_back(gather_item(*geometry, staged.mesh(i)));
    }
    staged.faults = gather_.record(commands, gathers);
    record_positions(commands, staged);
    return staged;
}

void MeshStore::record_positions(Commands& commands, const Staged& staged) const {
    const auto pass = commands.pass("vertices");
    for (std::size_t i = 0; i < staged.items.size(); ++i) {
        const auto& [geometry, stored] = staged.items[i];
        const Buffer& target = *(staged.made[i] ? staged.made[i] : stored->copy).buffer;
        if (staged.made[i] && !stored->gathers)
            commands.upload(target, std::span<const uvec3>(geometry->triangles), triangles_at(*geometry));
        const auto count = static_cast<uint>(3 * geometry->vertex_count());
        if (stored->incoming.address)
            copy_floats_.dispatch(commands, {stored->incoming, staged.mesh(i).positions, count, 1 / geometry->scale},
                                  count);
        else if (!stored->device_wrote)
            commands.upload(target, std::span<const vec3>(geometry->built_positions()));
    }
}

PackedMesh MeshStore::Staged::mesh_of(const StoredMesh& stored) const {
    const auto found = item_of.find(&stored);
    return found == item_of.end() ? stored.copy.mesh : mesh(found->second);
}

CostTarget MeshStore::Staged::cost_target(std::size_t item) const {
    return costs[item].bytes() ? costs[item].target() : items[item].stored->costs.target();
}

void MeshStore::Staged::retain_temporaries(Commands& commands) {
    for (std::size_t i = 0; i < items.size(); ++i)
        if (items[i].geometry->is_in_place()) commands.retain(std::move(*std::exchange(made[i], {}).buffer));
}

std::vector<StoredMesh*> MeshStore::commit(Staged&& staged, SyncPoint done) {
    gather_.commit(std::move(staged.faults), done);
    std::vector<StoredMesh*> all;
    for (std::size_t i = 0; i < staged.items.size(); ++i) {
        StoredMesh& stored = *staged.items[i].stored;
        if (staged.costs[i].bytes()) stored.costs = std::move(staged.costs[i]);
        if (staged.made[i]) stored.copy = std::move(staged.made[i]);
        stored.lent.reset();
        stored.device_wrote |= stored.incoming.address != 0;
        stored.edited = stored.gathers = stored.rebuilds = false;
        stored.incoming = {};
        all.push_back(&stored);
    }
    return all;
}

MeshOnDevice MeshStore::lend(Commands& commands, const Geometry& geometry, StoredMesh& stored) const {
    if (stored.copy || geometry.triangle_count() == 0) return stored.copy;
    if (const auto lent = stored.lent.lock()) return mesh_in(lent, 0, geometry.vertex_count(), geometry.scale);
    MeshOnDevice made = make_copy(geometry);
    if (geometry.device) {
        const MeshGather::Item item = gather_item(geometry, made.mesh);
        commands.retain(std::move(gather_.record(commands, std::span(&item, 1)).counts));
    } else {
        const auto pass = commands.pass("meshes");
        commands.upload(*made.buffer, std::span<const vec3>(geometry.built_positions()));
        commands.upload(*made.buffer, std::span<const uvec3>(geometry.triangles), triangles_at(geometry));
    }
    stored.lent = made.buffer;
    return made;
}

void MeshStore::download(Geometry& geometry, const StoredMesh& stored) const {
    if (!geometry.device && !stored.device_wrote) return;
    MeshOnDevice from = stored.copy;
    if (!from) {  // only the caller's memory has it
        from = make_copy(geometry);
        Commands commands(context_, "read mesh");
        const MeshGather::Item item = gather_item(geometry, from.mesh);
        const MeshGather::Faults faults = gather_.record(commands, std::span(&item, 1));
        commands.submit();
    }
    if (stored.device_wrote)
        geometry.positions =
            times(twinray::download<vec3>(context_, *from.buffer, geometry.vertex_count()), geometry.scale);
    if (geometry.device)
        geometry.triangles =
            twinray::download<uvec3>(context_, *from.buffer, geometry.triangle_count(), triangles_at(geometry));
    geometry.device.reset();
    geometry.non_finite_triangles = count_non_finite_triangles({geometry.name, geometry.positions, geometry.triangles});
}

}  // namespace twinray
