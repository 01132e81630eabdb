// SPDX-License-Identifier: MIT
#pragma once

#include "engine/scene/scene.h"
#include "samples/path_tracer/shared.h"

namespace twinray::path_tracer {

// aspect: width / height of the picture.
CameraRays camera_rays(const Camera& camera, float aspect);

// The whole scene with a vertical field of view of 40 degrees: from the front right and above, but turned to where
// its surfaces face if they face one way, so that rooms are seen through their open side and pictures from the front.
Camera frame_scene(const Scene& scene, float aspect);

}  // namespace twinray::path_tracer
