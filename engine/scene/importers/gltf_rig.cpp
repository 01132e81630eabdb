// SPDX-License-Identifier: MIT
#include "engine/scene/importers/gltf_nodes.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/scene/importers/gltf_accessor.h"
#include "engine/scene/importers/gltf_json.h"

namespace twinray {
namespace {

using nlohmann::json;

std::vector<std::int32_t> flat_indices(const GltfFile& file, const std::vector<GltfNode>& nodes) {
    std::vector<std::int32_t> flat(file.model.nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) flat[nodes[i].index] = static_cast<std::int32_t>(i);
    return flat;
}

std::size_t target_count(const tinygltf::Mesh& mesh) {
    std::size_t count = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) count = std::max(count, primitive.targets.size());
    return count;
}

// Returns the node's weights, else the mesh's, else none of any target.
std::vector<double> rest_weights(const GltfFile& file, const GltfNode& node) {
    const tinygltf::Node& source = file.model.nodes[node.index];
    if (source.mesh < 0 || std::size_t(source.mesh) >= file.model.meshes.size()) return {};
    const tinygltf::Mesh& mesh = file.model.meshes[std::size_t(source.mesh)];
    const std::size_t count = target_count(mesh);
    const std::vector<double>& given = source.weights.empty() ? mesh.weights : source.weights;
    if (given.empty()) return std::vector<double>(count, 0.0);
    if (given.size() != count)
        file.fail(node.name, ": there are ", given.size(), " morph weights, but its mesh has ", count, " targets");
    for (const double weight : given)
        if (!std::isfinite(static_cast<float>(weight)))
            file.fail(node.name, ": has the morph weight ", weight, ", which is not a finite float");
    return given;
}

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

Skin read_gltf_skin(const GltfFile& file, std::size_t index, const std::vector<std::int32_t>& flat) {
    const json& source = file.motion->at("skins")[index];
    Skin skin;
    skin.name = source.is_object() ? json_string(source, "name") : std::string();
    const std::string object = gltf_name("skin", index, skin.name);
    skin.joints = read_joints(file, source, flat, object);
    skin.inverse_binds = read_inverse_binds(file, source, skin.joints.size(), object);
    return skin;
}

// Reads skins. A mesh whose skin cannot be read has no place and is not shown. Its node loses it, with a warning.
std::vector<Skin> read_used_skins(GltfFile& file, const std::vector<GltfNode>& nodes,
                                  const std::vector<std::int32_t>& flat) {
    const json& sources = file.motion->at("skins");
    std::vector<Skin> skins(sources.is_array() ? sources.size() : 0);
    for (const GltfNode& node : nodes) {
        tinygltf::Node& source = file.model.nodes[node.index];
        if (source.skin < 0 || source.mesh < 0) continue;
        const std::size_t index = std::size_t(source.skin);
        try {
            if (index >= skins.size())
                file.fail(node.name, ": skin ", index, " does not exist; the file has ", skins.size());
            if (skins[index].joints.empty()) skins[index] = read_gltf_skin(file, index, flat);
        } catch (const Error& error) {
            file.warn(text(file.fault_of(error), "; the mesh of ", node.name, " is not shown"));
            source.mesh = source.skin = -1;
        }
    }
    return skins;
}

}  // namespace

Rig read_gltf_rig(GltfFile& file, const std::vector<GltfNode>& nodes) {
    const std::vector<std::int32_t> flat = flat_indices(file, nodes);
    Rig rig;
    for (const GltfNode& node : nodes) {
        rig.nodes.push_back(node.local);
        rig.nodes.back().weights = rest_weights(file, node);
    }
    rig.skins = read_used_skins(file, nodes, flat);
    rig.animations = read_gltf_animations(file, rig, flat);
    return rig;
}

}  // namespace twinray
