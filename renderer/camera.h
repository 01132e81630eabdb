// SPDX-License-Identifier: MIT
// Cameras as kernels take them.
#pragma once

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// aspect: width / height of the picture.
CameraRays camera_rays(const Camera& camera, float aspect);

}  // namespace twinray::path_tracer
