// SPDX-License-Identifier: MIT
#include "renderer/texture_list.h"

#include <algorithm>

namespace twinray::path_tracer {

TextureSlot TextureList::slot_of(const Texture& texture, bool is_srgb) {
    if (texture.image < 0) return {};
    const SampledTexture sampled{static_cast<uint>(texture.image),
                                 {texture.wrap_u, texture.wrap_v, is_srgb, texture.filter}};
    auto found = std::find(textures.begin(), textures.end(), sampled);
    if (found == textures.end()) found = textures.insert(found, sampled);
    return {{static_cast<uint>(found - textures.begin()) + 1}, texture.uv_set, texture.uv_row0, texture.uv_row1};
}

void push_textures(TextureStore& store, const Scene& scene, const TextureList& list) {
    for (const SampledTexture& texture : list.textures) store.push(scene.images[texture.image], texture.options);
}

}  // namespace twinray::path_tracer
