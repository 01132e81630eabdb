// SPDX-License-Identifier: MIT
// The pond in an accelerator, and a frame of it.
#pragma once

#include <vector>

#include <twinray/scene.h>
#include <twinray/tlas.h>

// [include]
#include "twinray/glsl/cpp.h"

namespace twinray {
using glm::sin;
#include "twinray/glsl/cpp_begin.h"
#include "pond.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray
// [/include]

using namespace twinray;

inline constexpr uint ball_count = BALLS_ACROSS * BALLS_ACROSS;

// A flat square of water, [-2, 2]^2 at height 0.
Mesh make_water();

class Pond {
  public:
    explicit Pond(AbstractAccel& accel);

    // Records a frame: kernels move everything, and the accelerator is refitted.
    void move(Commands& commands, float time);
    std::vector<Rgb> picture(uint width, uint height);
    std::vector<vec3> vertices() const;  // as they are on the device

  private:
    AbstractAccel& accel_;
    Mesh water_;
    AccelHandle water_handle_, balls_;
    Buffer positions_;
    Kernel<MoveArgs> waves_, float_balls_;
    QueryKernel<PictureArgs> picture_;
};
