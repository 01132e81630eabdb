// SwTlas's computations on the way to one triangle, beside the exact values: the arithmetic of the shaders run on the
// CPU. They explain a faulty ray.
#pragma once

#include <filesystem>
#include <iosfwd>

#include "report/frame/cases.h"
#include "report/frame/devices.h"
#include "validation/cpu_reference/reference_scene.h"
#include "validation/exact/exact_reference.h"

namespace twinray::replay {

class Explainer {
  public:
    // The scene is only read here; the reference must outlive it.
    Explainer(const Scene& scene, const ReferenceScene& reference, const Ray& ray, Level level);

    // Prints the triangle test: vertices as the ray sees them, edge functions in float32 and exactly, and what each
    // decides.
    void print_test(std::ostream& out, exact::TriangleId triangle) const;
    // Prints the boxes of SwTlas's trees that lead to it, and whether the ray enters them with the padding and without.
    void print_boxes(std::ostream& out, exact::TriangleId triangle) const;

  private:
    RaySpace object_space(uint instance) const;

    const ReferenceScene& reference_;
    Ray ray_;       // as given
    Ray searched_;  // as the level searches with it
    std::unique_ptr<reference::Scene> on_cpu_;
};

// Traces the ray of a replay file again on every accelerator of the device and prints step by step what each does and
// why it is right or wrong. Returns whether SwTlas still shows a fault of twinray. Throws Error if the scene is not the
// one that the file names.
bool show(const std::filesystem::path& file, frame::Devices& devices, std::ostream& out);

}  // namespace twinray::replay
