// SPDX-License-Identifier: MIT
// A scene on both accelerators, and what is made of it only when it is asked for.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <twinray/analysis.h>
#include <twinray/queries.h>
#include <twinray/tlas.h>
#include <twinray/validation.h>

#include "validation/cpu_reference/reference_scene.h"

namespace twinray::viewer {

class Stage {
  public:
    // Throws Error as load_scene() does.
    Stage(Context& context, const std::filesystem::path& file);

    const std::filesystem::path& file() const { return file_; }
    const Scene& scene() const { return scene_; }
    const Bounds& bounds() const { return bounds_; }
    SwTlas& software() { return software_; }
    HwTlas* hardware() { return hardware_.get(); }                           // null: see the next
    const std::string& why_no_hardware() const { return why_no_hardware_; }  // "" where there is one
    Context& context() const { return context_; }
    double build_seconds() const { return build_seconds_; }  // of both, with uploads

    double refit_seconds() const { return refit_seconds_; }  // of the last pose, on both; 0: there was none
    // Tells whether an animation moves it, and how long the first one lasts.
    double animation_seconds() const;
    // Poses the scene; both accelerators follow.
    void set_time(double seconds);
    // Counts what set_time() has changed.
    std::uint64_t version() const { return version_; }

    const Reference& reference();
    const reference::Scene& cpu_reference();  // the software accelerator on the host
    const Faces& faces();
    PointQuery& points();  // of the software accelerator, as it is
    bool has_level(Level level) const;

  private:
    void push();

    Context& context_;
    std::filesystem::path file_;
    Scene scene_;
    Bounds bounds_;
    SwTlas software_;
    std::unique_ptr<HwTlas> hardware_;
    std::string why_no_hardware_;
    std::vector<AccelHandle> software_handles_, hardware_handles_;  // by mesh with instances
    double build_seconds_ = 0, refit_seconds_ = 0;
    std::optional<double> time_;  // of the pose; none: not posed yet
    std::uint64_t version_ = 0;
    std::unique_ptr<Reference> reference_;
    std::unique_ptr<reference::Scene> cpu_reference_;
    std::unique_ptr<Faces> faces_;
    std::unique_ptr<PointQuery> points_;
};

}  // namespace twinray::viewer
