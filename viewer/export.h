// SPDX-License-Identifier: MIT
// What a layer says of faces, as a file.
#pragma once

#include <filesystem>

#include "viewer/layers.h"

namespace twinray::viewer {

// .csv: instance, triangle and value of each face that has one; .glb: the scene with its faces in the values' colours.
// Throws Error where values are none of faces, and naming the file.
void write_values(const std::filesystem::path& file, const Scene& scene, const Values& values);

}  // namespace twinray::viewer
