// SPDX-License-Identifier: MIT
#include "viewer/viewer.h"

#include <bit>
#include <cmath>

#include "engine/core/parallel.h"
#include "renderer/camera.h"

namespace twinray::viewer {
namespace {

constexpr uint most_samples = 1 << 20;

}  // namespace

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
