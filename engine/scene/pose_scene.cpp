// SPDX-License-Identifier: MIT
#include <algorithm>

#include "engine/scene/rig.h"
#include "twinray/glsl/cpp.h"

namespace twinray {

std::optional<glm::dmat4> unscaled(const glm::dmat4& world) {
    glm::dmat4 frame = world;
    for (int i = 0; i < 3; ++i) {
        const double scale = length(world[i]);
        if (!(scale > 0)) return std::nullopt;
        frame[i] /= scale;
    }
    return frame;
}

Transform transform_of(const glm::dmat4& matrix) { return Transform::of(glm::mat4(matrix)); }

void place_light(Light& light, const glm::dmat4& frame) {
    light.position = vec3(frame[3]);
    light.direction = -vec3(frame[2]);
}

void place_camera(Camera& camera, const glm::dmat4& frame) { camera.camera_to_world = transform_of(frame); }

void pose_scene(Scene& scene, const Pose& pose) { pose_scene(scene, *scene.rig, pose); }

std::vector<Transform> instance_transforms(const Rig& rig, const Pose& pose) {
    std::vector<Transform> transforms;
    for (const Rig::Attachment& attachment : rig.instances)
        transforms.push_back(transform_of(matrix_of(pose, attachment)));
    return transforms;
}

void pose_scene(Scene& scene, const Rig& rig, const Pose& pose) {
    const std::vector<Transform> transforms = instance_transforms(rig, pose);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) scene.instances[i].transform = transforms[i];
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        if (const auto frame = unscaled(frame_of(pose, rig.cameras[i]))) place_camera(scene.cameras[i], *frame);
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (const auto frame = unscaled(frame_of(pose, rig.lights[i]))) place_light(scene.lights[i], *frame);
}

void show_hidden(Scene& scene) {
    if (!scene.rig || scene.rig->hidden.empty()) return;
    auto rig = std::make_shared<Rig>(*scene.rig);
    for (Rig::Hidden& hidden : rig->hidden) {
        const auto next = std::ranges::upper_bound(scene.instances, hidden.instance.mesh, {}, &Instance::mesh);
        rig->instances.insert(rig->instances.begin() + (next - scene.instances.begin()), hidden.attachment);
        scene.instances.insert(next, std::move(hidden.instance));
    }
    rig->hidden.clear();
    scene.rig = std::move(rig);
}

}  // namespace twinray
