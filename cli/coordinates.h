// SPDX-License-Identifier: MIT
// Places of a scene in the coordinates of its file.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

#include "twinray/glsl/cpp.h"

namespace twinray::cli {

// "(1, 0, 0)": where this point of the scene is, with the digits that large coordinates need.
std::string coordinate_text(const dvec3& point, const dvec3& origin);
std::string coordinate_text(double coordinate, double origin);

nlohmann::json list_of(const dvec3& v);  // [x, y, z]

}  // namespace twinray::cli
