// SPDX-License-Identifier: MIT
// The room of tutorial 3: a box of side 1, open towards +z, with a lamp, a mirror and a ball.
#pragma once

#include <twinray/scene.h>
#include <twinray/tlas.h>

// [include]
#include "twinray/glsl/cpp_sampling.h"
#include "twinray/glsl/cpp_spawn.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "wave.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray
// [/include]

// [make]
inline twinray::Room make_room(float aspect) {
    using namespace twinray;
    const ImagePlane plane = image_plane(look_camera({0.5f, 0.5f, 2.4f}, {0.5f, 0.5f, 0}, {0, 1, 0}, 39), aspect);
    return {.looks = {{vec3(0.7f), DIFFUSE},
                      {vec3(0.6f, 0.06f, 0.05f), DIFFUSE},
                      {vec3(0.1f, 0.45f, 0.1f), DIFFUSE},
                      {vec3(0.95f), MIRROR},
                      {vec3(0.8f, 0.55f, 0.15f), DIFFUSE},
                      {vec3(0), LAMP}},
            .lamp = {{0.25f, 0.98f, 0.3f}, {0.5f, 0, 0}, {0, 0, 0.5f}, {7.5f, 7, 6}},
            .eye = {plane.origin, plane.right, plane.up, plane.forward}};
}

// Pushes the room; custom indices name the look of each part.
inline void push_room(twinray::AbstractAccel& accel, const twinray::Room& room) {
    using namespace twinray;
    const auto push = [&](const Mesh& mesh, uint look, const Transform& transform = {}) {
        accel.push(mesh, transform, {.custom_index = look, .mask = SOLID_MASK});
    };
    push(make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), 0);  // floor
    push(make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), 0);  // ceiling
    push(make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0);  // back
    push(make_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);  // left
    push(make_quad({1, 0, 0}, {0, 0, 1}, {0, 1, 0}), 2);  // right
    const Transform turned{{vec4(0.8f, 0, 0.6f, 0.33f), vec4(0, 1, 0, 0), vec4(-0.6f, 0, 0.8f, 0.34f)}};
    push(make_box({-0.14f, 0, -0.14f}, {0.14f, 0.6f, 0.14f}), 3, turned);
    push(make_icosphere(5, 0.16f), 4, Transform::translation({0.68f, 0.16f, 0.66f}));
    accel.push(make_quad(room.lamp.corner, room.lamp.u, room.lamp.v), {}, {.custom_index = 5, .mask = LAMP_MASK});
}
// [/make]
