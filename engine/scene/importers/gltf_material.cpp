#include "engine/scene/importers/gltf_parts.h"

#include "engine/scene/images.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {
// Keeps factors of glTF materials within what glTF allows: outside of it, surfaces would emit by reflecting.
float clamped_factor(double factor, double lo, double hi) {
    return static_cast<float>(factor >= lo ? std::min(factor, hi) : lo);  // NaN becomes lo
}

float unit_factor(double factor) { return clamped_factor(factor, 0, 1); }

template <int N>
Vec<N, float> color_factor(const std::vector<double>& factors, Vec<N, float> fallback, double most = 1) {
    if (factors.size() != N) return fallback;
    Vec<N, float> color;
    for (int i = 0; i < N; ++i) color[i] = clamped_factor(factors[std::size_t(i)], 0, most);
    return color;
}

Wrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp_to_edge;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirrored_repeat : Wrap::repeat;
}

// KHR_texture_transform: scale, then rotate, then offset. A positive rotation turns uv counter-clockwise as seen with v
// pointing down. The GLSL in the extension's text turns the other way and is known to be wrong (KhronosGroup/glTF issue
// 1563); the sample model, which this follows, is what implementations agree on.
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

// Roughness is 1 - factor * alpha, in the green channel.
template <class T>
std::vector<T> roughness_texels(const std::vector<T>& rgba, float factor) {
    constexpr float most = std::numeric_limits<T>::max();
    std::vector<T> texels(rgba.size(), static_cast<T>(most));
    for (std::size_t i = 0; i + 3 < rgba.size(); i += 4)
        texels[i + 1] = static_cast<T>(std::lround(most - factor * static_cast<float>(rgba[i + 3])));
    return texels;
}

// The picture has four channels.
template <class T>
bool uses_alpha(const std::vector<T>& rgba) {
    for (std::size_t i = 3; i < rgba.size(); i += 4)
        if (rgba[i] != std::numeric_limits<T>::max()) return true;
    return false;
}

// Turns glTF texture references into Textures, decoding each image on its first use.
class GltfTextures {
  public:
    GltfTextures(GltfFile& file, std::vector<Image>& images)
        : file_(file), images_(images), decoded_(file.model.images.size(), -1) {}

    // `object` names the user in errors and warnings: "material 3 'wood' baseColorTexture".
    Texture read(int texture, int texcoord, const tinygltf::ExtensionMap& extensions, const std::string& object) {
        if (texture == -1) return {};
        const tinygltf::Texture& source = file_.entry(file_.model.textures, texture, object, "texture");
        Texture result;
        result.image = image_of(source, object);
        set_sampler(result, source.sampler, object);
        if (const tinygltf::Value* transform = find_extension(extensions, "KHR_texture_transform")) {
            set_transform(result, *transform);
            if (const int own = index_of(*transform, "texCoord"); own >= 0) texcoord = own;
        }
        if (texcoord != 0 && texcoord != 1)
            file_.warn(text(object, ": asks for TEXCOORD_", texcoord, ", shown with TEXCOORD_0"));
        result.uv_set = texcoord == 1 ? 1 : 0;
        return result;
    }

    // Reads a reference inside an extension: member `key` of `parent`; no texture if it is absent.
    Texture read(const tinygltf::Value& parent, const std::string& key, const std::string& object) {
        const tinygltf::Value* reference = find_member(parent, key);
        if (!reference) return {};
        const int texcoord = std::max(index_of(*reference, "texCoord"), 0);
        return read(index_of(*reference, "index"), texcoord, extensions_of(*reference), text(object, " ", key));
    }

    // Returns a picture of roughness, from the glossiness in the alpha of a picture, for metallic_roughness_texture,
    // whose factors are 1; nothing if all alpha is 1.
    std::optional<Texture> roughness_of(const Texture& glossiness, float factor) {
        if (glossiness.image < 0) return std::nullopt;
        const Image& source = images_[std::size_t(glossiness.image)];
        if (!uses_alpha(source.rgba) && !uses_alpha(source.rgba16)) return std::nullopt;
        const auto [known, is_new] =
            roughness_.try_emplace({glossiness.image, factor}, static_cast<std::int32_t>(images_.size()));
        if (is_new) {
            Image image{source.name + " (roughness)", source.width, source.height,
                        roughness_texels(source.rgba, factor)};
            image.rgba16 = roughness_texels(source.rgba16, factor);
            images_.push_back(std::move(image));
        }
        Texture roughness = glossiness;
        roughness.image = known->second;
        return roughness;
    }

    // Returns whether the texture's image could not be decoded.
    bool is_placeholder(const Texture& texture) const {
        return texture.image >= 0 && images_[std::size_t(texture.image)].is_placeholder;
    }

  private:
    std::int32_t image_of(const tinygltf::Texture& texture, const std::string& object) {
        int source = texture.source;
        for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"})
            if (const tinygltf::Value* extension = find_extension(texture.extensions, name); extension && source < 0)
                source = index_of(*extension, "source");
        if (source == -1) return -1;
        const tinygltf::Image& image = file_.entry(file_.model.images, source, object, "image");
        std::int32_t& index = decoded_[std::size_t(source)];
        if (index < 0) {
            index = static_cast<std::int32_t>(images_.size());
            try {
                images_.push_back(decode(std::size_t(source)));
            } catch (const Error& e) {
                const std::string name = gltf_name("image", std::size_t(source), image.name);
                file_.warn(text(e.what(), "; ", name, " is shown as a checkerboard"));
                images_.push_back(checkerboard_image(name));
            }
        }
        return index;
    }

    Image decode(std::size_t index) const {
        const tinygltf::Image& image = file_.model.images[index];
        const std::string name = gltf_name("image", index, image.name.empty() ? image.uri.substr(0, 40) : image.name);
        if (!image.uri.empty()) return decode_image(read_uri(file_, image.uri), name);
        if (image.bufferView < 0) fail(name, " has neither a uri nor a bufferView");
        return decode_image(view_bytes(file_, image.bufferView, name), name);
    }

    // A picture has one level, so that minFilter has no effect.
    void set_sampler(Texture& result, int sampler, const std::string& object) const {
        if (sampler == -1) return;
        const tinygltf::Sampler& source = file_.entry(file_.model.samplers, sampler, object, "sampler");
        result.wrap_u = wrap_of(source.wrapS);
        result.wrap_v = wrap_of(source.wrapT);
        if (source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) result.filter = Filter::nearest;
    }

    GltfFile& file_;
    std::vector<Image>& images_;
    std::vector<std::int32_t> decoded_;  // glTF image -> index into images_, -1 = not yet
    std::map<std::pair<std::int32_t, float>, std::int32_t> roughness_;  // image and factor -> index into images_
};

constexpr double no_limit = 1e30;

// Reads members of one extension. `object` names the material in errors and warnings.
struct Reader {
    const tinygltf::Value& extension;
    const std::string& object;
    GltfTextures& textures;

    double number(const char* key, double fallback) const { return number_or(extension, key, fallback); }
    vec3 color(const char* key, vec3 fallback, double most = 1) const {
        return color_factor<3>(numbers_of(extension, key), fallback, most);
    }
    Texture texture(const char* key) const { return textures.read(extension, key, object); }

    // An unreadable map would only spoil the shape.
    Texture normal_texture(const char* key) const {
        const Texture normal = texture(key);
        return textures.is_placeholder(normal) ? Texture{} : normal;
    }
};

void read_specular(const Reader& from, Material& material) {
    material.specular = unit_factor(from.number("specularFactor", 1));
    material.specular_color = from.color("specularColorFactor", vec3(1), no_limit);
    material.specular_texture = from.texture("specularTexture");
    material.specular_color_texture = from.texture("specularColorTexture");
}

// Reads the material in terms of KHR_materials_specular, which can express all of it: an index of refraction of 0
// reflects everything times the specular colour.
void read_specular_glossiness(const Reader& from, Material& material) {
    material.base_color = color_factor<4>(numbers_of(from.extension, "diffuseFactor"), vec4(1));
    material.base_color_texture = from.texture("diffuseTexture");
    material.metallic = 0;
    material.ior = 0;
    material.specular_color = from.color("specularFactor", vec3(1));
    material.specular_color_texture = from.texture("specularGlossinessTexture");
    const float glossiness = unit_factor(from.number("glossinessFactor", 1));
    const std::optional<Texture> roughness = from.textures.roughness_of(material.specular_color_texture, glossiness);
    material.roughness = roughness ? 1 : 1 - glossiness;
    material.metallic_roughness_texture = roughness.value_or(Texture{});
}

void read_clearcoat(const Reader& from, Material& material) {
    material.clearcoat = unit_factor(from.number("clearcoatFactor", 0));
    material.clearcoat_roughness = unit_factor(from.number("clearcoatRoughnessFactor", 0));
    material.clearcoat_texture = from.texture("clearcoatTexture");
    material.clearcoat_roughness_texture = from.texture("clearcoatRoughnessTexture");
    material.clearcoat_normal_texture = from.normal_texture("clearcoatNormalTexture");
    if (const tinygltf::Value* normal = find_member(from.extension, "clearcoatNormalTexture"))
        material.clearcoat_normal_scale = clamped_factor(number_or(*normal, "scale", 1), -no_limit, no_limit);
}

void read_sheen(const Reader& from, Material& material) {
    material.sheen_color = from.color("sheenColorFactor", vec3(0));
    material.sheen_roughness = unit_factor(from.number("sheenRoughnessFactor", 0));
    material.sheen_color_texture = from.texture("sheenColorTexture");
    material.sheen_roughness_texture = from.texture("sheenRoughnessTexture");
}

void read_anisotropy(const Reader& from, Material& material) {
    material.anisotropy = unit_factor(from.number("anisotropyStrength", 0));
    material.anisotropy_rotation = clamped_factor(from.number("anisotropyRotation", 0), -no_limit, no_limit);
    material.anisotropy_texture = from.texture("anisotropyTexture");
}

// Rays measure the thickness. It only matters whether there is a volume, and a texture does not tell that.
void read_volume(const Reader& from, Material& material) {
    material.thickness = clamped_factor(from.number("thicknessFactor", 0), 0, no_limit);
    material.attenuation_color = from.color("attenuationColor", vec3(1));
    if (find_member(from.extension, "attenuationDistance"))
        material.attenuation_distance =
            clamped_factor(from.number("attenuationDistance", 1), std::numeric_limits<float>::min(), no_limit);
}

void read_transmission(const Reader& from, Material& material) {
    material.transmission = unit_factor(from.number("transmissionFactor", 0));
    material.transmission_texture = from.texture("transmissionTexture");
}

// Takes one extension into `material`; it ignores others than these.
void read_extension(const std::string& name, const Reader& from, Material& material) {
    if (name == "KHR_materials_anisotropy") read_anisotropy(from, material);
    if (name == "KHR_materials_clearcoat") read_clearcoat(from, material);
    if (name == "KHR_materials_emissive_strength")
        material.emission *= clamped_factor(from.number("emissiveStrength", 1), 0, no_limit);
    if (name == "KHR_materials_ior") material.ior = clamped_factor(from.number("ior", 1.5), 0, no_limit);
    if (name == "KHR_materials_pbrSpecularGlossiness") read_specular_glossiness(from, material);
    if (name == "KHR_materials_sheen") read_sheen(from, material);
    if (name == "KHR_materials_specular") read_specular(from, material);
    if (name == "KHR_materials_transmission") read_transmission(from, material);
    if (name == "KHR_materials_unlit") material.unlit = true;
    if (name == "KHR_materials_volume") read_volume(from, material);
}

AlphaMode alpha_mode_of(const std::string& mode) {
    if (mode == "MASK") return AlphaMode::mask;
    return mode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
}

void read_surface(const tinygltf::Material& source, Material& material) {
    const auto& pbr = source.pbrMetallicRoughness;
    material.base_color = color_factor<4>(pbr.baseColorFactor, vec4(1));
    material.metallic = unit_factor(pbr.metallicFactor);
    material.roughness = unit_factor(pbr.roughnessFactor);
    material.emission = color_factor<3>(source.emissiveFactor, vec3(0));
    material.alpha_mode = alpha_mode_of(source.alphaMode);
    material.alpha_cutoff = clamped_factor(source.alphaCutoff, 0, no_limit);
    material.double_sided = source.doubleSided;
    material.normal_scale = clamped_factor(source.normalTexture.scale, -no_limit, no_limit);
}

void read_texture_slots(const tinygltf::Material& source, GltfTextures& textures, const std::string& object,
                        Material& material) {
    const auto& pbr = source.pbrMetallicRoughness;
    const auto slot = [&](const auto& info, const char* name) {
        return textures.read(info.index, info.texCoord, info.extensions, text(object, " ", name));
    };
    material.base_color_texture = slot(pbr.baseColorTexture, "baseColorTexture");
    material.metallic_roughness_texture = slot(pbr.metallicRoughnessTexture, "metallicRoughnessTexture");
    material.emission_texture = slot(source.emissiveTexture, "emissiveTexture");
    material.normal_texture = slot(source.normalTexture, "normalTexture");
    // A checkerboard of colours is a warning; read as normals it would only spoil the shape.
    if (textures.is_placeholder(material.normal_texture)) material.normal_texture = {};
}

}  // namespace

void read_gltf_materials(GltfFile& file, Scene& scene) {
    GltfTextures textures(file, scene.images);
    for (std::size_t i = 0; i < file.model.materials.size(); ++i) {
        const tinygltf::Material& source = file.model.materials[i];
        const std::string object = gltf_name("material", i, source.name);
        Material& material = scene.materials.emplace_back();
        material.name = source.name.empty() ? text("material ", i) : source.name;
        read_surface(source, material);
        read_texture_slots(source, textures, object, material);
        for (const auto& [name, extension] : source.extensions)
            read_extension(name, {extension, object, textures}, material);
    }
}

}  // namespace twinray
