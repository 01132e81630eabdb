// SPDX-License-Identifier: MIT
// Textures of a scene, each uploaded once.
#pragma once

#include <vector>

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// An image of the scene as materials sample it.
struct SampledTexture {
    uint image;
    TextureOptions options;
    bool operator==(const SampledTexture&) const = default;
};

// The textures of a scene's materials, each once, in the order in which records name them.
struct TextureList {
    std::vector<SampledTexture> textures = {};

    // Adds the texture where it is not there; all zero for none.
    TextureSlot slot_of(const Texture& texture, bool is_srgb);
};

// Pushes them into a store without any: the references of slot_of hold in it.
void push_textures(TextureStore& store, const Scene& scene, const TextureList& list);

}  // namespace twinray::path_tracer
