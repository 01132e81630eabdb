// SPDX-License-Identifier: MIT
#pragma once

#include "engine/scene/scene.h"
#include "samples/path_tracer/shared.h"

namespace twinray::path_tracer {

// aspect: width / height of the picture.
CameraRays camera_rays(const Camera& camera, float aspect);

// A three-quarter view from the front right and above with a vertical field of view of 40 degrees, so near that the
// box just fits.
Camera frame_bounds(const Bounds& bounds, float aspect);

}  // namespace twinray::path_tracer
