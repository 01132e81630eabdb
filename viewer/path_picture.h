// SPDX-License-Identifier: MIT
// The scene path traced, a sample of each pixel after the other.
#pragma once

#include <cmath>
#include <memory>

#include "samples/path_tracer/lights.h"
#include "samples/path_tracer/renderer.h"
#include "samples/path_tracer/scene_upload.h"
#include "validation/picture/raster.h"
#include "viewer/orbit.h"

namespace twinray::viewer {

class PathPicture {
  public:
    // Compiles and uploads what the scene needs. It must outlive this.
    PathPicture(Context& context, const Scene& scene);

    // Begins anew where what is seen differs from what was.
    void look(const Orbit& orbit, uint width, uint height, const AbstractAccel& accel, std::uint64_t version);
    void add_sample(AbstractAccel& accel);
    uint samples() const { return samples_; }
    double seconds() const;  // that the samples took
    std::uint64_t rays() const;
    // Of the picture, relative, at most: see Film::error(). Of the last power of two of samples; infinite before two.
    double error() const { return error_; }
    Raster picture(float exposure) const;

  private:
    struct View {
        Orbit orbit;
        uint width = 0, height = 0;
        const AbstractAccel* accel = nullptr;
        std::uint64_t version = 0;
        bool operator==(const View&) const = default;
    };

    Context& context_;
    path_tracer::LocalLights lights_;
    std::unique_ptr<path_tracer::EnvironmentMap> environment_;
    std::unique_ptr<path_tracer::DeviceScene> device_scene_;
    std::unique_ptr<path_tracer::Renderer> renderer_;
    View view_;
    path_tracer::Film film_;
    uint samples_ = 0;
    double error_ = INFINITY;
};

}  // namespace twinray::viewer
