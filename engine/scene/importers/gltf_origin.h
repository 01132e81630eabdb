// SPDX-License-Identifier: MIT
// The local origin of a glTF scene.
#pragma once

#include <optional>

#include <twinray/scene.h>

#include "engine/scene/rig.h"

namespace twinray {

// Moves a scene in its rest pose to a local origin, `wanted` or chosen for its contents, and the rig with it:
// transforms are composed again in float64, relative to the origin, and rounded once. Vertices that are themselves as
// large as that, or that a node brings back from far away, are also moved, and their instances the other way: rays are
// rounded in the space of the mesh. Without need, or if 0 is wanted, nothing changes, bit for bit.
void move_to_origin(const std::optional<dvec3>& wanted, Scene& scene, Rig& rig);

}  // namespace twinray
