// SPDX-License-Identifier: MIT
#include "samples/path_tracer/camera.h"

#include "engine/core/error.h"

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

Camera look_camera(vec3 from, vec3 at, vec3 up, float fov) {
    const dvec3 way = dvec3(from) - dvec3(at), right = cross(dvec3(up), way);
    if (!(dot(way, way) > 0) || !(dot(right, right) > 0) || !is_finite(from) || !is_finite(at) || !is_finite(up))
        fail("camera at (", from.x, ", ", from.y, ", ", from.z, ") looking at (", at.x, ", ", at.y, ", ", at.z,
             "): the two must differ, and not in the direction (", up.x, ", ", up.y, ", ", up.z,
             ") alone, which is up");
    const dvec3 back = normalize(way), x = normalize(right), y = cross(back, x);
    Camera camera;
    camera.name = "command line";
    camera.camera_to_world = {
        {vec4(x.x, y.x, back.x, from.x), vec4(x.y, y.y, back.y, from.y), vec4(x.z, y.z, back.z, from.z)}};
    camera.vertical_fov = glm::radians(fov);
    return camera;
}

}  // namespace twinray::path_tracer
