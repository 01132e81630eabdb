// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <twinray/abstract_accel.h>
#include "engine/scene/scene.h"

namespace twinray {

// Pushes every mesh with all its instances, so that Hit::instance_index is the index into scene.instances and
// Hit::custom_index 1 + Instance::material, or 0 where it has none. Returns one
// handle per mesh that has instances. Throws Error unless scene.instances is grouped by mesh, as load_scene leaves it.
std::vector<AccelHandle> push_scene(AbstractAccel& accel, const Scene& scene);

}  // namespace twinray
