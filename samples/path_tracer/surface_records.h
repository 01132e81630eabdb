// SPDX-License-Identifier: MIT
// From Scene to the records that the kernels read: plain data in, plain data out.
#pragma once

#include <vector>

#include "engine/scene/scene.h"
#include "samples/path_tracer/shared.h"

namespace twinray::path_tracer {

std::vector<SurfaceVertex> vertex_records(const Mesh& mesh);
std::vector<SurfaceTriangle> triangle_records(const Mesh& mesh);
std::vector<SurfaceMaterial> material_records(const Scene& scene);

// References left null.
SurfaceInstance instance_record(const Transform& transform);

// Sets `flag` in `flags` where there is a texture.
TextureSlot slot_of(const Texture& texture, uint flag, uint& flags);

}  // namespace twinray::path_tracer
