// SPDX-License-Identifier: MIT
#include "engine/scene/importers/gltf_texture.h"

#include <algorithm>
#include <cmath>

#include <twinray/scene.h>

#include "engine/scene/importers/placeholder.h"

namespace twinray {
namespace {

Wrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp_to_edge;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirrored_repeat : Wrap::repeat;
}

// KHR_texture_transform: scale, then rotate, then offset. A positive rotation turns uv counter-clockwise as seen
// with v pointing down. The GLSL in the extension's text turns the other way and is known to be wrong
// (KhronosGroup/glTF issue 1563); the sample model, which this follows, is what implementations agree on.
void set_transform(Texture& texture, const tinygltf::Value& transform) {
    std::vector<double> offset = numbers_of(transform, "offset"), scale = numbers_of(transform, "scale");
    if (offset.size() != 2) offset = {0, 0};
    if (scale.size() != 2) scale = {1, 1};
    const double angle = number_or(transform, "rotation", 0);
    const double c = std::cos(angle), s = std::sin(angle);
    texture.uv_row0 = vec3(c * scale[0], s * scale[1], offset[0]);
    texture.uv_row1 = vec3(-s * scale[0], c * scale[1], offset[1]);
}

tinygltf::ExtensionMap extensions_of(const tinygltf::Value& reference) {
    tinygltf::ExtensionMap extensions;
    if (const tinygltf::Value* members = find_member(reference, "extensions"))
        for (const std::string& key : members->Keys()) extensions[key] = members->Get(key);
    return extensions;
}

}  // namespace

GltfTextures::GltfTextures(GltfFile& file, std::vector<Image>& images)
    : file_(file), images_(images), decoded_(file.model.images.size(), -1) {}

Texture GltfTextures::read(int texture, int texcoord, const tinygltf::ExtensionMap& extensions,
                           const std::string& object) {
    if (texture == -1) return {};
    const auto& textures = file_.model.textures;
    if (texture < 0 || std::size_t(texture) >= textures.size())
        file_.fail(object, ": texture ", texture, " does not exist; the file has ", textures.size());
    Texture result;
    result.image = image_of(textures[std::size_t(texture)], object);
    set_sampler(result, textures[std::size_t(texture)].sampler, object);
    if (const tinygltf::Value* transform = find_extension(extensions, "KHR_texture_transform")) {
        set_transform(result, *transform);
        if (const int own = index_of(*transform, "texCoord"); own >= 0) texcoord = own;
    }
    if (texcoord != 0 && texcoord != 1)
        file_.warn(text(object, ": asks for TEXCOORD_", texcoord, ", shown with TEXCOORD_0"));
    result.uv_set = texcoord == 1 ? 1 : 0;
    return result;
}

Texture GltfTextures::read(const tinygltf::Value& parent, const std::string& key, const std::string& object) {
    const tinygltf::Value* reference = find_member(parent, key);
    if (!reference) return {};
    const int texcoord = std::max(index_of(*reference, "texCoord"), 0);
    return read(index_of(*reference, "index"), texcoord, extensions_of(*reference), text(object, " ", key));
}

std::int32_t GltfTextures::image_of(const tinygltf::Texture& texture, const std::string& object) {
    int source = texture.source;
    for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp", "MSFT_texture_dds"})
        if (const tinygltf::Value* extension = find_extension(texture.extensions, name); extension && source < 0)
            source = index_of(*extension, "source");
    if (source == -1) return -1;
    if (source < 0 || std::size_t(source) >= file_.model.images.size())
        file_.fail(object, ": image ", source, " does not exist; the file has ", file_.model.images.size());
    std::int32_t& index = decoded_[std::size_t(source)];
    if (index < 0) {
        index = static_cast<std::int32_t>(images_.size());
        try {
            images_.push_back(decode(std::size_t(source)));
        } catch (const Error& e) {
            const std::string name =
                gltf_name("image", std::size_t(source), file_.model.images[std::size_t(source)].name);
            file_.warn(text(e.what(), "; ", name, " is shown as a checkerboard"));
            images_.push_back(checkerboard_image(name));
        }
    }
    return index;
}

Image GltfTextures::decode(std::size_t index) const {
    const tinygltf::Image& image = file_.model.images[index];
    const std::string name = gltf_name("image", index, image.name.empty() ? image.uri.substr(0, 40) : image.name);
    if (!image.uri.empty()) return decode_image(read_uri(file_, image.uri), name);
    if (image.bufferView < 0) fail(name, " has neither a uri nor a bufferView");
    return decode_image(view_bytes(file_, image.bufferView, name), name);
}

// A picture has one level, so that minFilter is of no effect.
void GltfTextures::set_sampler(Texture& result, int sampler, const std::string& object) const {
    if (sampler == -1) return;
    const auto& samplers = file_.model.samplers;
    if (sampler < 0 || std::size_t(sampler) >= samplers.size())
        file_.fail(object, ": sampler ", sampler, " does not exist; the file has ", samplers.size());
    result.wrap_u = wrap_of(samplers[std::size_t(sampler)].wrapS);
    result.wrap_v = wrap_of(samplers[std::size_t(sampler)].wrapT);
    if (samplers[std::size_t(sampler)].magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) result.filter = Filter::nearest;
}

}  // namespace twinray
