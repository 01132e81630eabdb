// SPDX-License-Identifier: MIT
#include "engine/scene/importers/gltf_accessor.h"
#include "engine/scene/importers/gltf_json.h"
#include "engine/scene/importers/gltf_rig.h"

namespace twinray {
namespace {

using nlohmann::json;

std::vector<uint> read_joints(const GltfFile& file, const json& source, const std::vector<std::int32_t>& flat,
                              const std::string& object) {
    const json joints = source.is_object() ? source.value("joints", json()) : json();
    if (!joints.is_array() || joints.empty()) file.fail(object, ": has no list of joints");
    std::vector<uint> result;
    for (const json& joint : joints) {
        if (!joint.is_number_unsigned() || joint.get<std::uint64_t>() >= flat.size())
            file.fail(object, ": joint ", joint.dump().substr(0, 40), " does not exist; the file has ", flat.size(),
                      " nodes");
        const std::int32_t node = flat[joint.get<std::size_t>()];
        if (node < 0) file.fail(object, ": joint ", joint.dump(), " is a node that is not in the shown scene");
        result.push_back(static_cast<uint>(node));
    }
    return result;
}

std::vector<glm::dmat4> read_inverse_binds(const GltfFile& file, const json& source, std::size_t count,
                                           const std::string& object) {
    if (!source.contains("inverseBindMatrices")) return std::vector<glm::dmat4>(count, glm::dmat4(1));
    const auto accessor = json_count(source, "inverseBindMatrices");
    const std::string name = object + ": inverseBindMatrices";
    if (!accessor || *accessor > INT32_MAX) file.fail(name, " is not a non-negative integer");
    const std::vector<float> floats = read_floats(file, static_cast<int>(*accessor), 16, name);
    const std::vector<double> entries(floats.begin(), floats.end());
    if (entries.size() / 16 < count)
        file.fail(name, " has ", entries.size() / 16, " matrices, but there are ", count, " joints");
    std::vector<glm::dmat4> matrices;
    for (std::size_t i = 0; i < count; ++i) {
        const auto matrix = std::span(entries).subspan(16 * i).first<16>();
        matrices.push_back(affine_matrix(file, matrix, text(name, " ", i)));
    }
    return matrices;
}

}  // namespace

Skin read_gltf_skin(const GltfFile& file, std::size_t index, const std::vector<std::int32_t>& flat) {
    const json& source = file.motion->at("skins")[index];
    Skin skin;
    skin.name = source.is_object() ? json_string(source, "name") : std::string();
    const std::string object = gltf_name("skin", index, skin.name);
    skin.joints = read_joints(file, source, flat, object);
    skin.inverse_binds = read_inverse_binds(file, source, skin.joints.size(), object);
    return skin;
}

}  // namespace twinray
