// Converts cameras to the form that kernels take.
#pragma once

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// aspect: width / height of the picture.
inline CameraRays camera_rays(const Camera& camera, float aspect) {
    const ImagePlane plane = image_plane(camera, aspect);
    return {plane.origin, plane.right, plane.up, plane.forward, plane.is_orthographic ? 1u : 0u, 0, 0};
}

}  // namespace twinray::path_tracer
