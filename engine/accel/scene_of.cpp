// Pushes a scene into an accelerator, and reads one back.
#include <algorithm>

#include "engine/accel/held_geometry.h"
#include "engine/accel/placed_meshes.h"
#include "engine/core/error.h"

namespace twinray {

std::vector<AccelHandle> push_scene(AbstractAccel& accel, const Scene& scene) {
    const auto by_mesh = [](const Instance& a, const Instance& b) { return a.mesh < b.mesh; };
    if (!std::is_sorted(scene.instances.begin(), scene.instances.end(), by_mesh))
        fail(accel.name(), ": push_scene: the scene's instances are not grouped by mesh");
    std::vector<AccelHandle> handles;
    for (auto first = scene.instances.begin(); first != scene.instances.end();) {
        const auto last = std::upper_bound(first, scene.instances.end(), *first, by_mesh);
        std::vector<Transform> transforms;
        std::vector<InstanceOptions> options;
        for (auto instance = first; instance != last; ++instance) {
            transforms.push_back(instance->transform);
            options.push_back({.custom_index = instance->material ? *instance->material + 1 : 0});
        }
        handles.push_back(accel.push(scene.meshes[first->mesh], transforms, options));
        first = last;
    }
    return handles;
}

PlacedMeshes::PlacedMeshes(const Scene& scene) : meshes(scene.meshes.begin(), scene.meshes.end()) {
    for (const Instance& instance : scene.instances) instances.push_back({instance.mesh, instance.transform});
}

PlacedMeshes::PlacedMeshes(AbstractAccel& accel) : accel_(&accel) {
    accel.sync();
    handles_ = accel.handles();
    for (const AccelHandle handle : handles_) {
        for (const InstanceState& state : accel.get_instances(handle)) {
            if (const std::string fault = fault_of(state.transform); !fault.empty())
                fail(accel.name(), ": scene_of: instance ", instances.size(), ": ", fault);
            instances.push_back({static_cast<uint>(owned_.size()), state.transform});
        }
        owned_.push_back(accel.mesh(handle));
    }
    meshes.assign(owned_.begin(), owned_.end());
}

std::vector<MeshOnDevice> PlacedMeshes::on_device(Commands& commands, std::span<const uint> some) const {
    if (accel_ && &accel_->context() == &commands.context()) {
        std::vector<MeshOnDevice> lent;
        for (const uint mesh : some) lent.push_back(accel_->backend().lend_mesh(commands, handles_[mesh]));
        return lent;
    }
    std::vector<MeshView> views;
    for (const uint mesh : some) views.push_back(meshes[mesh]);
    return upload_meshes(commands, views);
}

std::vector<std::size_t> triangle_counts(const PlacedMeshes& placed) {
    std::vector<std::size_t> counts;
    for (const MeshInstance& instance : placed.instances)
        counts.push_back(placed.meshes[instance.mesh].triangles.size());
    return counts;
}

Scene scene_of(AbstractAccel& accel) {
    const PlacedMeshes placed(accel);
    Scene scene;
    scene.materials.resize(1);
    for (const MeshView& mesh : placed.meshes) {
        Mesh& copy = scene.meshes.emplace_back();
        copy.name = mesh.name;
        copy.positions.assign(mesh.positions.begin(), mesh.positions.end());
        copy.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    }
    for (const auto& [mesh, transform] : placed.instances) scene.instances.push_back({"", mesh, transform, {}});
    return scene;
}

MeshOnDevice AccelBackend::lend_mesh(Commands& commands, AccelHandle handle) {
    HeldGeometry& held = *live(handle, "lending its mesh").held;
    return meshes_->lend(commands, held.geometry, held.stored);
}

SharedMesh AccelBackend::mesh(AccelHandle handle) const {
    const auto shared = [](const Geometry& geometry) {
        return SharedMesh{geometry.name, geometry.positions, geometry.triangles};
    };
    const HeldGeometry& held = *live(handle, "mesh").held;
    if (held.geometry.device || held.stored.device_wrote) return shared(geometry(handle));
    check_mesh_is_kept(held, "mesh");
    return shared(held.geometry);
}

std::vector<uint> AccelBackend::face_metadata(AccelHandle handle) const {
    const PushedGeometry& pushed = live(handle, "face_metadata");
    const SurfaceSlice& surface = pushed.held->surface;
    const std::size_t count = pushed.held->geometry.triangle_count();
    if (!surface.face_metadata) return std::vector<uint>(count);
    return surfaces_->read(surface, *surface.face_metadata, count);
}

}  // namespace twinray
