#include "viewer/viewer.h"

#include <bit>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/core/stopwatch.h"
#include "engine/core/commands.h"
#include "renderer/camera.h"
#include "renderer/moving_scene.h"

namespace twinray::viewer {
namespace {

// Allows all levels that the device can compute.
AccelOptions options_for(const DeviceProperties& device, bool is_software) {
    return {.level = !device.shader_float64 ? Level::watertight : is_software ? Level::certified : Level::refined};
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

constexpr uint most_samples = 1 << 20;

}  // namespace

Stage::Stage(Context& context, const std::filesystem::path& file)
    : context_(context),
      file_(file),
      scene_(load_scene(file)),
      software_(context, options_for(context.properties(), true)) {
    if (scene_.rig) show_hidden(scene_);
    bounds_ = bounds_of(scene_);
    if (const std::vector<std::string> missing = missing_for_hardware(context.properties()); !missing.empty())
        why_no_hardware_ = missing.front();
    else
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

PathPicture::PathPicture(Context& context, const Scene& scene, std::uint64_t version, bool has_all_features)
    : context_(context),
      version_(version),
      has_all_features_(has_all_features),
      lights_(path_tracer::collect_lights(scene)) {
    if (!path_tracer::has_lamps(scene))
        environment_ = std::make_unique<path_tracer::EnvironmentMap>(path_tracer::default_sky());
    device_scene_ = std::make_unique<path_tracer::DeviceScene>(
        context, scene, lights_, environment_.get(),
        has_all_features ? path_tracer::all_features(scene)
                         : path_tracer::features_of(scene, lights_, environment_.get()));
}

void PathPicture::look(const Orbit& orbit, uint width, uint height) {
    const View view{orbit, width, height};
    if (renderer_ && view == view_) return;
    const path_tracer::CameraRays camera =
        path_tracer::camera_rays(camera_of(orbit), static_cast<float>(width) / static_cast<float>(height));
    if (!renderer_ || view.width != view_.width || view.height != view_.height) {
        path_tracer::RenderSettings settings{.width = width, .height = height, .samples = most_samples};
        settings.camera = camera;
        renderer_ = std::make_unique<path_tracer::Renderer>(context_, *device_scene_, settings);
    }
    renderer_->set_frame(camera, 1);
    film_ = renderer_->make_film();
    renderer_->start(film_);
    samples_ = 0;
    error_ = INFINITY;
    view_ = view;
}

void PathPicture::add_sample(AbstractAccel& accel) {
    renderer_->add_block(accel, samples_);
    ++samples_;
    renderer_->read(film_);
    film_.blocks.insert(samples_ - 1);
    if (std::has_single_bit(samples_)) error_ = film_.error();
}

double PathPicture::seconds() const { return renderer_ ? renderer_->stats().seconds : 0; }
std::uint64_t PathPicture::rays() const {
    return renderer_ ? renderer_->stats().path_rays + renderer_->stats().shadow_rays : 0;
}

Raster PathPicture::picture(float exposure) const {
    const HdrImage mean = film_.mean();
    Raster raster(mean.width, mean.height);
    const float factor = std::exp2(exposure);
    parallel_for(raster.pixels.size(), [&](std::size_t i) { raster.pixels[i] = rgb_of_linear(mean.rgb[i] * factor); });
    return raster;
}

}  // namespace twinray::viewer
