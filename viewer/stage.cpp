// SPDX-License-Identifier: MIT
#include "viewer/viewer.h"

#include "engine/core/error.h"
#include "engine/core/stopwatch.h"
#include "engine/core/uploaded.h"
#include "renderer/moving_scene.h"

namespace twinray::viewer {
namespace {

// Allows all levels that the device can compute.
AccelOptions options_for(const DeviceProperties& device, bool is_software) {
    return {.level = !device.shader_float64 ? Level::watertight : is_software ? Level::certified : Level::refined};
}

std::string lacking_for(const DeviceProperties& device) {
    const std::vector<std::string> missing = missing_for_hardware(device);
    return missing.empty() ? "" : missing.front();
}

// Transforms come from device memory, where one may be singular: its instance is then not seen.
Buffer upload_transforms(Context& context, const Scene& scene) {
    std::vector<Transform> transforms;
    for (const Instance& instance : scene.instances) transforms.push_back(instance.transform);
    return uploaded(context, "viewer transforms", std::span<const Transform>(transforms));
}

void move(AbstractAccel& accel, const Scene& scene, const std::vector<AccelHandle>& handles, const Buffer& transforms) {
    for (std::size_t first = 0; first < scene.instances.size();) {
        const AccelHandle handle = handles[scene.instances[first].mesh];
        const std::size_t count = accel.n_instances(handle);
        accel.update_transforms(handle, transforms.ref<Transform>(first * sizeof(Transform)), count);
        first += count;
    }
    const std::vector<uint> meshes = deformed_meshes(*scene.rig);
    for (std::size_t i = 0; i < meshes.size(); ++i)
        if (handles[meshes[i]] != AccelHandle{})
            accel.update_vertices(handles[meshes[i]], scene.meshes[meshes[i]].positions);
    accel.sync();
}

}  // namespace

Stage::Stage(Context& context, const std::filesystem::path& file)
    : context_(context),
      file_(file),
      scene_(load_scene(file)),
      software_(context, options_for(context.properties(), true)) {
    if (scene_.rig) show_hidden(scene_);
    bounds_ = bounds_of(scene_);
    why_no_hardware_ = lacking_for(context.properties());
    if (why_no_hardware_.empty())
        hardware_ = std::make_unique<HwTlas>(context, BuildOrder::automatic, options_for(context.properties(), false));
    const Stopwatch start;
    push();
    set_time(0);
    build_seconds_ = start.seconds();
}

void Stage::push() {
    software_handles_ = path_tracer::handles_by_mesh(scene_, push_scene(software_, scene_));
    software_.sync();
    if (hardware_) {
        hardware_handles_ = path_tracer::handles_by_mesh(scene_, push_scene(*hardware_, scene_));
        hardware_->sync();
    }
    context_.wait_for_gpu();
}

double Stage::animation_seconds() const {
    if (!scene_.rig) return 0;
    const std::vector<AnimationInfo> animations = animations_of(*scene_.rig);
    return animations.empty() || !animations[0].fault.empty() ? 0 : animations[0].range.end;
}

void Stage::set_time(double seconds) {
    if (animation_seconds() == 0 || time_ == seconds) return;
    const Stopwatch start;
    const Pose pose = pose_at(*scene_.rig, 0, seconds);
    pose_scene(scene_, pose);
    const std::vector<uint> meshes = deformed_meshes(*scene_.rig);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        MeshVertices moved = deformed(*scene_.rig, i, pose);
        scene_.meshes[meshes[i]].positions = std::move(moved.positions);
        scene_.meshes[meshes[i]].normals = std::move(moved.normals);
    }
    const Buffer transforms = upload_transforms(context_, scene_);
    move(software_, scene_, software_handles_, transforms);
    if (hardware_) move(*hardware_, scene_, hardware_handles_, transforms);
    context_.wait_for_gpu();
    refit_seconds_ = start.seconds();
    bounds_ = bounds_of(scene_);
    time_ = seconds;
    ++version_;
    reference_.reset();
    cpu_reference_.reset();
    faces_.reset();
    points_.reset();
}

const Reference& Stage::reference() {
    if (!reference_) reference_ = std::make_unique<Reference>(scene_);
    return *reference_;
}

const reference::Scene& Stage::cpu_reference() {
    if (!cpu_reference_) cpu_reference_ = reference::cpu_reference_of(scene_);
    return *cpu_reference_;
}

PointQuery& Stage::points() {
    if (points_) return *points_;
    points_ = std::make_unique<PointQuery>(context_);
    points_->set(software_);
    return *points_;
}

bool Stage::has_level(Level level) const { return level <= software_.options().level; }

const Faces& Stage::faces() {
    if (!faces_) faces_ = std::make_unique<Faces>(software_);
    return *faces_;
}

}  // namespace twinray::viewer
