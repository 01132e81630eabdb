// SPDX-License-Identifier: MIT
#include "renderer/camera.h"

namespace twinray::path_tracer {

CameraRays camera_rays(const Camera& camera, float aspect) {
    const ImagePlane plane = image_plane(camera, aspect);
    CameraRays rays{};
    rays.origin = plane.origin;
    rays.right = plane.right;
    rays.up = plane.up;
    rays.forward = plane.forward;
    rays.orthographic = plane.is_orthographic ? 1 : 0;
    return rays;
}

}  // namespace twinray::path_tracer
