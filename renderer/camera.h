// SPDX-License-Identifier: MIT
// Converts cameras to the form that kernels take.
#pragma once

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// aspect: width / height of the picture.
CameraRays camera_rays(const Camera& camera, float aspect);

}  // namespace twinray::path_tracer
