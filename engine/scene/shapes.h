// SPDX-License-Identifier: MIT
// Scenes made by formula, for tests, samples and benchmarks. The same bits everywhere.
#pragma once

#include "engine/scene/scene.h"

namespace twinray {

// A box of [-1, 1]^3, open towards +z, with white walls, a red one left (-x), a green one right, a light under the
// ceiling, a metal box and a glass sphere; with a camera that sees all of it.
Scene cornell_box_scene();

// 1200 glazed and golden beads in the spiral of a sunflower on a table, seen from above at an aspect of 16 : 9; without
// lights, for a sky.
Scene sunflower_scene();

}  // namespace twinray
