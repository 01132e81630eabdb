// SPDX-License-Identifier: MIT
// Cameras: which one shows a whole scene, and where its picture shows which point.
#pragma once

#include <optional>

#include "engine/core/ray.h"
#include "engine/scene/scene.h"

namespace twinray {

// The whole scene with a vertical field of view of 40 degrees; aspect: width / height of the picture. `direction`: in
// which it looks, in world space; without, from the front right and above, but turned to where surfaces face if they
// face one way, so that rooms are seen through their open side and pictures from the front. Up is +y, or -z in pictures
// that look straight up or down. Throws Error for a direction that is 0 or not finite.
Camera frame_scene(const Scene& scene, float aspect, const std::optional<vec3>& direction = {});

// What a camera sees. The point (x, y) of its picture, from -1 to 1 to the right and upwards, shows what lies from
// `origin` along forward + right * x + up * y; in orthographic pictures from origin + right * x + up * y along forward.
struct ImagePlane {
    vec3 origin, right, up, forward;  // `forward` is as long as 1, and the three are perpendicular
    bool is_orthographic;
};
// All of the camera's frame is seen, whatever the picture's aspect, and what is beside it.
ImagePlane image_plane(const Camera& camera, float aspect);

// Its `t` is the depth along `forward`.
Ray ray_through(const ImagePlane& plane, vec2 point);

struct Projected {
    vec2 point;
    float depth;
};
// None for points behind the camera.
std::optional<Projected> project(const ImagePlane& plane, dvec3 position);

}  // namespace twinray
