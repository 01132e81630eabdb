// SPDX-License-Identifier: MIT
// What materials have beyond the plain surface, as the kernels read it.
#pragma once

#include "renderer/surface_records.h"

namespace twinray::path_tracer {

// LAYER_ bits of what changes anything.
uint layers_of(const Material& material);

// One per material. Adds their textures to the list.
std::vector<LayeredMaterial> layered_records(const Scene& scene, TextureList& textures);

bool has_texture(const Material& material);
// Whether a texture of it takes the second texture coordinates.
bool has_second_uvs(const Material& material);

}  // namespace twinray::path_tracer
