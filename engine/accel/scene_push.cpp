// SPDX-License-Identifier: MIT
#include <algorithm>

#include <twinray/scene.h>

#include <twinray/abstract_accel.h>
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

}  // namespace twinray
