// SPDX-License-Identifier: MIT
// Parts of faces from which rays between two of them leave: pure functions.
#pragma once

#include "engine/analysis/polygon64.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/face_part.h"
#include "twinray/glsl/cpp_end.h"

// `part` has 3 or 4 vertices in the plane of `triangle`, whose vertices are in the order of the mesh.
FacePart part_of_face(const Polygon64& triangle, const Polygon64& part);

}  // namespace twinray
