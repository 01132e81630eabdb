// SPDX-License-Identifier: MIT
#include <cmath>

#include "engine/scene/importers/gltf_file.h"
#include "engine/scene/importers/gltf_mesh.h"

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

std::string gltf_name(const char* kind, std::size_t index, const std::string& name) {
    return name.empty() ? text(kind, " ", index) : text(kind, " ", index, " '", name, "'");
}

const tinygltf::Value* find_member(const tinygltf::Value& object, const std::string& key) {
    return object.Has(key) ? &object.Get(key) : nullptr;
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double number_or(const tinygltf::Value& object, const std::string& key, double fallback) {
    const tinygltf::Value* member = find_member(object, key);
    return member && member->IsNumber() ? member->GetNumberAsDouble() : fallback;
}

int index_of(const tinygltf::Value& object, const std::string& key) {
    const double number = number_or(object, key, -1);
    return number >= 0 && number <= INT32_MAX ? static_cast<int>(number) : -1;
}

std::vector<double> numbers_of(const tinygltf::Value& object, const std::string& key) {
    std::vector<double> numbers;
    const tinygltf::Value* member = find_member(object, key);
    if (!member || !member->IsArray()) return numbers;
    for (int i = 0; i < static_cast<int>(member->ArrayLen()); ++i)
        if (const tinygltf::Value& entry = member->Get(i); entry.IsNumber())
            numbers.push_back(entry.GetNumberAsDouble());
    return numbers;
}

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
