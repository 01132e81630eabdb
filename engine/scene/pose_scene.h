// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "engine/scene/animation.h"
#include "engine/scene/scene.h"

namespace twinray {

// The frame without its scale, which glTF keeps from cameras and lights; nothing when an axis has no length.
std::optional<glm::dmat4> unscaled(const glm::dmat4& world);

// Rounded to float, whatever comes of it.
Transform transform_of(const glm::dmat4& matrix);

// A light's or a camera's place; `frame` as unscaled() leaves it.
void place_light(Light& light, const glm::dmat4& frame);
void place_camera(Camera& camera, const glm::dmat4& frame);

// Moves instances, cameras and lights of a scene with a rig. Transforms are what the pose makes of them, also singular
// or not finite. A camera or light whose frame has an axis without length stays. Meshes stay: see
// engine/scene/deform.h.
void pose_scene(Scene& scene, const Pose& pose);
void pose_scene(Scene& scene, const Rig& rig, const Pose& pose);

// Gives the hidden instances of a rig, if there are any, a place in the scene, before it is pushed into an accelerator
// and played: until the first pose_scene() they stand at the identity.
void show_hidden(Scene& scene);

}  // namespace twinray
