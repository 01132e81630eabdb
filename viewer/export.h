// SPDX-License-Identifier: MIT
// Writes a layer's values of faces to a file.
#pragma once

#include <filesystem>

#include "viewer/layers.h"

namespace twinray::viewer {

// .csv: instance, triangle and value of each face that has one; .glb: the scene with its faces in the values' colours.
// Throws Error if values are not those of faces, and naming the file if it cannot be written.
void write_values(const std::filesystem::path& file, const Scene& scene, const Values& values);

}  // namespace twinray::viewer
