// SPDX-License-Identifier: MIT
#include "engine/scene/rig.h"

#include <algorithm>

#include "engine/scene/flat.h"
#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {

glm::dmat3 rotation_matrix(const dvec4& q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const double s = 2 / (x * x + y * y + z * z + w * w);  // files round their unit quaternions
    return {1 - s * (y * y + z * z), s * (x * y + z * w),     s * (x * z - y * w),
            s * (x * y - z * w),     1 - s * (x * x + z * z), s * (y * z + x * w),
            s * (x * z + y * w),     s * (y * z - x * w),     1 - s * (x * x + y * y)};
}

// The local transforms that an animation drives, node by node.
struct Locals {
    std::vector<Trs> transforms;
    std::vector<std::vector<double>> weights;
};

Locals rest_locals(const Rig& rig) {
    Locals locals;
    for (const Rig::Node& node : rig.nodes) {
        locals.transforms.push_back(node.rest);
        locals.weights.push_back(node.weights);
    }
    return locals;
}

void drive(Locals& locals, const Animation::Channel& channel, const std::vector<double>& value) {
    Trs& trs = locals.transforms[channel.node];
    switch (channel.path) {
        case Animation::Channel::Path::translation: trs.translation = {value[0], value[1], value[2]}; break;
        case Animation::Channel::Path::rotation: trs.rotation = {value[0], value[1], value[2], value[3]}; break;
        case Animation::Channel::Path::scale: trs.scale = {value[0], value[1], value[2]}; break;
        case Animation::Channel::Path::weights: locals.weights[channel.node] = value; break;
    }
}

Pose pose_of(const Rig& rig, Locals&& locals) {
    Pose::Nodes pose;
    pose.weights = std::move(locals.weights);
    for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
        const Rig::Node& node = rig.nodes[i];
        const auto parent = static_cast<std::size_t>(node.parent);
        const glm::dmat4 local = node.is_fixed ? node.matrix : matrix_of(locals.transforms[i]);
        const glm::dmat4 axes = node.is_fixed ? node.matrix : frame_of(locals.transforms[i]);
        pose.nodes.push_back(node.parent < 0 ? local : pose.nodes[parent] * local);
        if (node.parent < 0) pose.nodes.back()[3] -= dvec4(rig.origin, 0);
        pose.frames.push_back(node.parent < 0 ? axes : pose.frames[parent] * axes);
        pose.frames.back()[3] = pose.nodes.back()[3];
    }
    return Pose(std::make_shared<const Pose::Nodes>(std::move(pose)));
}

}  // namespace

glm::dmat4 matrix_of(const Trs& trs) {
    glm::dmat4 matrix(rotation_matrix(trs.rotation));
    for (int i = 0; i < 3; ++i) {
        matrix[i] *= trs.scale[i];
        matrix[3][i] = trs.translation[i];
    }
    return matrix;
}

glm::dmat4 frame_of(const Trs& trs) {
    Trs grown = trs;
    for (int i = 0; i < 3; ++i)
        if (trs.scale[i] == 0) grown.scale[i] = 1;
    return matrix_of(grown);
}

TimeRange range_of(const Animation& animation) {
    if (animation.keyframes.empty()) return {};
    TimeRange range{INFINITY, -INFINITY};
    for (const Keyframes& keyframes : animation.keyframes) {
        range.begin = std::min(range.begin, static_cast<double>(keyframes.times.front()));
        range.end = std::max(range.end, static_cast<double>(keyframes.times.back()));
    }
    return range;
}

std::vector<AnimationInfo> animations_of(const Rig& rig) {
    std::vector<AnimationInfo> infos;
    for (const Animation& animation : rig.animations)
        infos.push_back({animation.name, range_of(animation), animation.fault});
    return infos;
}

Pose rest_pose(const Rig& rig) { return pose_of(rig, rest_locals(rig)); }

Pose pose_at(const Rig& rig, const Animation& animation, double seconds) {
    Locals locals = rest_locals(rig);
    for (const Animation::Channel& channel : animation.channels)
        drive(locals, channel, value_at(animation.keyframes[channel.keyframes], seconds));
    return pose_of(rig, std::move(locals));
}

Pose pose_at(const Rig& rig, std::size_t animation, double seconds) {
    return pose_at(rig, rig.animations[animation], seconds);
}

glm::dmat4 matrix_of(const Pose& pose, const Rig::Attachment& attachment) {
    const glm::dmat4 matrix = attachment.node < 0
                                  ? attachment.local
                                  : pose->nodes[static_cast<std::size_t>(attachment.node)] * attachment.local;
    return thickened(matrix, attachment.thickness);
}

glm::dmat4 frame_of(const Pose& pose, const Rig::Attachment& attachment) {
    return attachment.node < 0 ? attachment.local
                               : pose->frames[static_cast<std::size_t>(attachment.node)] * attachment.local;
}

std::vector<Transform> joint_transforms(const Skin& skin, const Pose& pose) {
    std::vector<Transform> transforms;
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
        transforms.push_back(Transform::of(glm::mat4(pose->nodes[skin.joints[i]] * skin.inverse_binds[i])));
    return transforms;
}

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
