// SPDX-License-Identifier: MIT
// From Scene to the records that the kernels read: plain data in, plain data out.
#pragma once

#include <vector>

#include <twinray/scene.h>

#include "renderer/texture_list.h"

namespace twinray::path_tracer {

std::vector<SurfaceVertex> vertex_records(const Mesh& mesh);
std::vector<SurfaceTriangle> triangle_records(const Mesh& mesh);
// Adds the textures of the materials to the list.
std::vector<SurfaceMaterial> material_records(const Scene& scene, TextureList& textures);

// References left null.
SurfaceInstance instance_record(const Transform& transform);

}  // namespace twinray::path_tracer
