// SPDX-License-Identifier: MIT
// The layers of materials beyond the plain surface, as the kernels read them.
#pragma once

#include "renderer/surface_records.h"

namespace twinray::path_tracer {

// Returns LAYER_ bits of the layers that have an effect.
uint layers_of(const Material& material);

// Returns one per material. Adds their textures to the list.
std::vector<LayeredMaterial> layered_records(const Scene& scene, TextureList& textures);

bool has_texture(const Material& material);
// Returns whether one of its textures uses the second texture coordinates.
bool has_second_uvs(const Material& material);

}  // namespace twinray::path_tracer
