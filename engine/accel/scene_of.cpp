// SPDX-License-Identifier: MIT
// A scene into an accelerator, and back.
#include <twinray/scene.h>

#include <algorithm>

#include <twinray/abstract_accel.h>
#include "engine/accel/held_geometry.h"
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

Scene scene_of(AbstractAccel& accel) {
    accel.sync();
    const AccelBackend& backend = accel.backend();
    Scene scene;
    scene.materials.resize(1);
    for (const AccelHandle handle : accel.handles()) {
        const auto mesh = static_cast<uint>(scene.meshes.size());
        scene.meshes.push_back(backend.held_mesh(handle));
        for (const InstanceState& state : accel.get_instances(handle)) {
            if (const std::string fault = fault_of(state.transform); !fault.empty())
                fail(accel.name(), ": scene_of: instance ", scene.instances.size(), ": ", fault);
            scene.instances.push_back({"", mesh, state.transform, {}});
        }
    }
    return scene;
}

Mesh AccelBackend::held_mesh(AccelHandle handle) const {
    const Geometry held = geometry(handle);
    Mesh mesh;
    mesh.name = held.name;
    mesh.positions = held.given_positions();
    mesh.triangles = held.triangles;
    return mesh;
}

std::vector<uint> AccelBackend::face_metadata(AccelHandle handle) const {
    const PushedGeometry& pushed = live(handle, "face_metadata");
    const SurfaceSlice& surface = pushed.held->surface;
    const std::size_t count = pushed.held->geometry.triangle_count();
    if (!surface.face_metadata) return std::vector<uint>(count);
    return surfaces_->read(surface, *surface.face_metadata, count);
}

}  // namespace twinray
