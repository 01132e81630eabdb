// SPDX-License-Identifier: MIT
#include "engine/scene/importers/gltf_variants.h"

namespace twinray {
namespace {

constexpr const char* extension_name = "KHR_materials_variants";

// Returns the entries of a list in the extension; none if there is no such list.
std::vector<tinygltf::Value> entries_of(const tinygltf::ExtensionMap& extensions, const char* list) {
    const tinygltf::Value* extension = find_extension(extensions, extension_name);
    const tinygltf::Value* member = extension ? find_member(*extension, list) : nullptr;
    return member && member->IsArray() ? member->Get<tinygltf::Value::Array>() : std::vector<tinygltf::Value>();
}

}  // namespace

std::vector<std::string> read_variant_names(const GltfFile& file) {
    std::vector<std::string> names;
    for (const tinygltf::Value& variant : entries_of(file.model.extensions, "variants")) {
        const tinygltf::Value* name = find_member(variant, "name");
        names.push_back(name && name->IsString() ? name->Get<std::string>() : text("variant ", names.size()));
    }
    return names;
}

std::vector<int> read_variant_materials(const GltfFile& file, const tinygltf::Primitive& primitive,
                                        const std::string& object) {
    const std::vector<tinygltf::Value> mappings = entries_of(primitive.extensions, "mappings");
    if (mappings.empty()) return {};
    const std::size_t count = entries_of(file.model.extensions, "variants").size();
    std::vector<int> materials(count, -1);
    for (const tinygltf::Value& mapping : mappings) {
        const int material = index_of(mapping, "material");
        if (material < 0 || std::size_t(material) >= file.model.materials.size())
            file.fail(object, ": ", extension_name, " names material ", material, "; the file has ",
                      file.model.materials.size());
        for (const double variant : numbers_of(mapping, "variants")) {
            if (!(variant >= 0) || !(variant < static_cast<double>(count)))
                file.fail(object, ": ", extension_name, " names variant ", variant, "; the file has ", count);
            materials[static_cast<std::size_t>(variant)] = material;
        }
    }
    return materials;
}

}  // namespace twinray
