// SPDX-License-Identifier: MIT
#include <cmath>

#include "engine/scene/importers/gltf_file.h"

namespace twinray {

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

}  // namespace twinray
