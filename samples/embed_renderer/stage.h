// SPDX-License-Identifier: MIT
// What is shown: a scene on a ground, with balls that circle around it.
#pragma once

#include <twinray/scene.h>

namespace twinray::embed_renderer {

struct Stage {
    Scene scene;            // with the ground and, last, the balls
    Bounds bounds;          // of the scene alone
    uint ball_count = 0;    // the last instances
    vec3 center = vec3(0);  // on the ground, of the circle
    float orbit = 0;        // its radius
    float ball_radius = 0;
};

// Throws Error for an empty scene. Without ground the balls stay, for rooms that have a floor of their own.
Stage make_stage(Scene scene, uint ball_count, bool has_ground);

}  // namespace twinray::embed_renderer
