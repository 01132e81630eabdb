// SPDX-License-Identifier: MIT
#pragma once

#include <twinray/scene.h>

#include "samples/path_tracer/shared.h"

namespace twinray::path_tracer {

// aspect: width / height of the picture.
CameraRays camera_rays(const Camera& camera, float aspect);

}  // namespace twinray::path_tracer
