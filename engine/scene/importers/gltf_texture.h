// SPDX-License-Identifier: MIT
// Textures of glTF.
#pragma once

#include <twinray/scene.h>

#include "engine/scene/importers/gltf_file.h"

namespace twinray {

// Turns glTF texture references into Textures, decoding each image on its first use.
class GltfTextures {
  public:
    GltfTextures(GltfFile& file, std::vector<Image>& images);

    // `object` names the user in errors and warnings: "material 3 'wood' baseColorTexture".
    Texture read(int texture, int texcoord, const tinygltf::ExtensionMap& extensions, const std::string& object);

    // A reference inside an extension: member `key` of `parent`; no texture when it is absent.
    Texture read(const tinygltf::Value& parent, const std::string& key, const std::string& object);

    // Whether its image could not be decoded.
    bool is_placeholder(const Texture& texture) const {
        return texture.image >= 0 && images_[std::size_t(texture.image)].is_placeholder;
    }

  private:
    std::int32_t image_of(const tinygltf::Texture& texture, const std::string& object);
    Image decode(std::size_t image) const;
    void set_sampler(Texture& result, int sampler, const std::string& object) const;

    GltfFile& file_;
    std::vector<Image>& images_;
    std::vector<std::int32_t> decoded_;  // glTF image -> index into images_, -1 = not yet
};

}  // namespace twinray
