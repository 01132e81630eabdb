// SPDX-License-Identifier: MIT
// Path traces the scene, one sample of each pixel after the other.
#pragma once

#include <cmath>
#include <memory>

#include "renderer/lights.h"
#include "renderer/renderer.h"
#include "renderer/scene_upload.h"
#include "viewer/picture/raster.h"
#include "viewer/orbit.h"

namespace twinray::viewer {

class PathPicture {
  public:
    // Compiles and uploads what the scene needs in its present state: `version` distinguishes it from later ones. The
    // scene must outlive this. has_all_features: compiles what any scene may need, to see what leaving out saves.
    PathPicture(Context& context, const Scene& scene, std::uint64_t version, bool has_all_features);
    bool is_of(std::uint64_t version, bool has_all_features) const {
        return version_ == version && has_all_features_ == has_all_features;
    }

    // Starts again if the view differs from the last one.
    void look(const Orbit& orbit, uint width, uint height);
    void add_sample(AbstractAccel& accel);
    uint samples() const { return samples_; }
    double seconds() const;  // that the samples took
    std::uint64_t rays() const;
    // Bounds the relative error (see Film::error()) at the last power of two of samples; infinite before two.
    double error() const { return error_; }
    Raster picture(float exposure) const;

  private:
    struct View {
        Orbit orbit;
        uint width = 0, height = 0;
        bool operator==(const View&) const = default;
    };

    Context& context_;
    std::uint64_t version_;
    bool has_all_features_;
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
