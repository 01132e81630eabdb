// SPDX-License-Identifier: MIT
#pragma once

#include "engine/picture/view.h"
#include "samples/path_tracer/shared.h"

namespace twinray::path_tracer {

// aspect: width / height of the picture.
CameraRays camera_rays(const Camera& camera, float aspect);

// A perspective camera. fov: vertical, in degrees. Throws Error unless `at` lies elsewhere, in another direction than
// up.
Camera look_camera(vec3 from, vec3 at, vec3 up, float fov);

}  // namespace twinray::path_tracer
