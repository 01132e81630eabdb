#include "renderer/moving_scene.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <twinray/scene.h>

namespace twinray::path_tracer {
namespace {

class Stopwatch {
  public:
    // Returns the milliseconds since the last call.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double, std::milli>(now - std::exchange(start_, now)).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

bool emits(const Scene& scene, uint mesh) {
    const auto glows = [&](uint material) { return largest(scene.materials[material].emission) > 0; };
    for (const Instance& instance : scene.instances)
        if (instance.mesh == mesh && instance.material && glows(*instance.material)) return true;
    return std::ranges::any_of(scene.meshes[mesh].materials, glows);
}

}  // namespace

std::vector<AccelHandle> handles_by_mesh(const Scene& scene, const std::vector<AccelHandle>& handles) {
    std::vector<AccelHandle> by_mesh(scene.meshes.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        if (i == 0 || scene.instances[i].mesh != scene.instances[i - 1].mesh)
            by_mesh[scene.instances[i].mesh] = handles[next++];
    return by_mesh;
}

MovingScene::MovingScene(Context& context, Scene& scene, DeviceScene& device_scene, AbstractAccel& accel)
    : context_(context),
      scene_(scene),
      device_scene_(device_scene),
      accel_(accel),
      handles_(handles_by_mesh(scene, accel.handles())),
      deformed_(deformed_meshes(*scene.rig)),
      deformer_(context, scene.rig),
      transforms_(array_of<Transform>(context, "transforms", scene.instances.size())) {
    for (std::size_t i = 0; i < deformed_.size(); ++i)
        if (emits(scene, deformed_[i])) emitting_.push_back(i);
    if (deformed_.empty()) return;
    share_vertices();
    move_records();
    move_vertices(rest_pose(*scene.rig));
    accel.sync();
}

void MovingScene::share_vertices() {
    for (std::size_t i = 0; i < deformed_.size(); ++i) {
        const Deformer::Output moved = deformer_.output(i);
        const Mesh& mesh = scene_.meshes[deformed_[i]];
        device_scene_.use_vertices(deformed_[i], moved);
        accel_.update(handles_[deformed_[i]], DeviceMesh{.name = mesh.name,
                                                         .positions = moved.positions.address(),
                                                         .vertex_count = moved.vertex_count,
                                                         .indices = device_scene_.indices(deformed_[i]).address,
                                                         .triangle_count = mesh.triangles.size(),
                                                         .bounds = bounds_of(mesh),
                                                         .in_place = true});
    }
}

MotionTimes MovingScene::move_to(const Pose& pose) {
    MotionTimes times;
    context_.wait_for_gpu();
    Stopwatch stopwatch;
    const std::vector<Instance> before = scene_.instances;
    pose_scene(scene_, pose);
    move_emitters(pose);
    move_records();
    context_.wait_for_gpu();
    times.host = stopwatch.lap();
    move_vertices(pose);
    context_.wait_for_gpu();
    times.vertices = stopwatch.lap();
    if (!edit_accel(before)) return times;
    accel_.sync();
    context_.wait_for_gpu();
    times.refit = stopwatch.lap();
    for (const PassTiming& pass : accel_.build_timings()) times.refit_device += pass.ms;
    return times;
}

void MovingScene::move_records() { device_scene_.move(scene_, collect_lights(scene_, device_scene_.light_choice())); }

void MovingScene::move_emitters(const Pose& pose) {
    for (const std::size_t i : emitting_)
        scene_.meshes[deformed_[i]].positions = deformed(*scene_.rig, i, pose).positions;
}

void MovingScene::move_vertices(const Pose& pose) {
    if (deformed_.empty()) return;
    Commands commands(context_, "path tracer move");
    deformer_.record(commands, pose);
    commands.submit();
}

bool MovingScene::edit_accel(const std::vector<Instance>& before) {
    for (const uint mesh : deformed_) accel_.mark_vertices_dirty(handles_[mesh]);
    // The transforms come from device memory, where one may be singular: its instance is then not seen.
    std::vector<Transform> transforms;
    for (const Instance& instance : scene_.instances) transforms.push_back(instance.transform);
    submit_pass(context_, "path tracer transforms",
                [&](Commands& commands) { commands.upload(transforms_, std::span<const Transform>(transforms)); });
    bool has_edits = !deformed_.empty();
    for (std::size_t first = 0; first < transforms.size();) {
        const AccelHandle handle = handles_[scene_.instances[first].mesh];
        const std::size_t count = accel_.n_instances(handle);
        bool has_moved = false;
        for (std::size_t i = first; i < first + count; ++i) has_moved |= transforms[i] != before[i].transform;
        if (has_moved) accel_.update_transforms(handle, transforms_.ref<Transform>(first * sizeof(Transform)), count);
        has_edits |= has_moved;
        first += count;
    }
    return has_edits;
}

}  // namespace twinray::path_tracer
