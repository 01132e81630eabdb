// SPDX-License-Identifier: MIT
#include "samples/path_tracer/camera.h"

#include <algorithm>
#include <cmath>

namespace twinray::path_tracer {
namespace {

vec3 column(const Transform& transform, int index) {
    return {transform.rows[0][index], transform.rows[1][index], transform.rows[2][index]};
}

Transform camera_at(vec3 position, vec3 right, vec3 up, vec3 backward) {
    return {{vec4(right.x, up.x, backward.x, position.x), vec4(right.y, up.y, backward.y, position.y),
             vec4(right.z, up.z, backward.z, position.z)}};
}

}  // namespace

CameraRays camera_rays(const Camera& camera, float aspect) {
    const bool is_orthographic = camera.orthographic_half_height.has_value();
    const float half_height = is_orthographic ? *camera.orthographic_half_height : std::tan(camera.vertical_fov / 2);
    const Transform& frame = camera.camera_to_world;
    CameraRays rays{};
    rays.origin = column(frame, 3);
    rays.right = normalize(column(frame, 0)) * (half_height * aspect);
    rays.up = normalize(column(frame, 1)) * half_height;
    rays.forward = -normalize(column(frame, 2));
    rays.orthographic = is_orthographic ? 1 : 0;
    return rays;
}

Camera frame_bounds(const Bounds& bounds, float aspect) {
    constexpr float vertical_fov = 40 * PI / 180, margin = 1.04f;
    const vec3 backward = normalize(vec3(0.55f, 0.4f, 1));
    const vec3 right = normalize(cross(vec3(0, 1, 0), backward)), up = cross(backward, right);
    const float tangent = std::tan(vertical_fov / 2) / margin;
    float distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 point = vec3(corner & 1 ? bounds.hi.x : bounds.lo.x, corner & 2 ? bounds.hi.y : bounds.lo.y,
                                corner & 4 ? bounds.hi.z : bounds.lo.z) -
                           bounds.center();
        const float reach = std::max(std::abs(dot(point, up)), std::abs(dot(point, right)) / aspect) / tangent;
        distance = std::max(distance, dot(point, backward) + reach);
    }
    Camera camera;
    camera.name = "framing the scene";
    camera.camera_to_world = camera_at(bounds.center() + backward * distance, right, up, backward);
    camera.vertical_fov = vertical_fov;
    return camera;
}

}  // namespace twinray::path_tracer
