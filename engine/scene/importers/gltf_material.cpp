// SPDX-License-Identifier: MIT
#include "engine/scene/importers/gltf_material.h"

#include "engine/scene/importers/gltf_factors.h"
#include "engine/scene/importers/gltf_layers.h"
#include "engine/scene/importers/gltf_texture.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {

AlphaMode alpha_mode_of(const std::string& mode) {
    if (mode == "MASK") return AlphaMode::mask;
    return mode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
}

class MaterialReader {
  public:
    MaterialReader(GltfFile& file, std::vector<Image>& images) : file_(file), textures_(file, images) {}

    Material read(std::size_t index) {
        const tinygltf::Material& source = file_.model.materials[index];
        const std::string object = gltf_name("material", index, source.name);
        Material material;
        material.name = source.name.empty() ? text("material ", index) : source.name;
        read_surface(source, material);
        read_texture_slots(source, object, material);
        for (const auto& [name, extension] : source.extensions) read_extension(name, extension, object, material);
        return material;
    }

  private:
    static void read_surface(const tinygltf::Material& source, Material& material) {
        const auto& pbr = source.pbrMetallicRoughness;
        material.base_color = color_factor<4>(pbr.baseColorFactor, vec4(1));
        material.metallic = unit_factor(pbr.metallicFactor);
        material.roughness = unit_factor(pbr.roughnessFactor);
        material.emission = color_factor<3>(source.emissiveFactor, vec3(0));
        material.alpha_mode = alpha_mode_of(source.alphaMode);
        material.alpha_cutoff = clamped_factor(source.alphaCutoff, 0, 1e30);
        material.double_sided = source.doubleSided;
        material.normal_scale = clamped_factor(source.normalTexture.scale, -1e30, 1e30);
    }

    void read_texture_slots(const tinygltf::Material& source, const std::string& object, Material& material) {
        const auto& pbr = source.pbrMetallicRoughness;
        const auto slot = [&](const auto& info, const char* name) {
            return textures_.read(info.index, info.texCoord, info.extensions, text(object, " ", name));
        };
        material.base_color_texture = slot(pbr.baseColorTexture, "baseColorTexture");
        material.metallic_roughness_texture = slot(pbr.metallicRoughnessTexture, "metallicRoughnessTexture");
        material.emission_texture = slot(source.emissiveTexture, "emissiveTexture");
        material.normal_texture = slot(source.normalTexture, "normalTexture");
        // Colours of a checkerboard warn; read as normals they would only spoil the shape.
        if (textures_.is_placeholder(material.normal_texture)) material.normal_texture = {};
    }

    void read_extension(const std::string& name, const tinygltf::Value& extension, const std::string& object,
                        Material& material) {
        if (name == "KHR_materials_emissive_strength") {
            material.emission *= clamped_factor(number_or(extension, "emissiveStrength", 1), 0, 1e30);
        } else if (name == "KHR_materials_ior") {
            material.ior = clamped_factor(number_or(extension, "ior", 1.5), 0, 1e30);
        } else if (name == "KHR_materials_unlit") {
            material.unlit = true;
        } else if (name == "KHR_materials_transmission") {
            material.transmission = unit_factor(number_or(extension, "transmissionFactor", 0));
            material.transmission_texture = textures_.read(extension, "transmissionTexture", object);
        } else if (name == "KHR_materials_pbrSpecularGlossiness") {
            material.base_color = color_factor<4>(numbers_of(extension, "diffuseFactor"), vec4(1));
            material.base_color_texture = textures_.read(extension, "diffuseTexture", object);
            material.metallic = 0;
            material.roughness = 1 - unit_factor(number_or(extension, "glossinessFactor", 1));
            file_.warn("KHR_materials_pbrSpecularGlossiness is shown by its diffuse colour and glossiness alone");
        } else {
            read_gltf_layer(name, extension, object, textures_, material);
        }
    }

    GltfFile& file_;
    GltfTextures textures_;
};

}  // namespace

void read_gltf_materials(GltfFile& file, Scene& scene) {
    MaterialReader reader(file, scene.images);
    for (std::size_t i = 0; i < file.model.materials.size(); ++i) scene.materials.push_back(reader.read(i));
}

}  // namespace twinray
