// SPDX-License-Identifier: MIT
#include "engine/scene/importers/gltf_vertices.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/importers/gltf_accessor.h"

namespace twinray {
namespace {

using tinygltf::Primitive;

void check_count(const GltfFile& file, std::size_t count, std::size_t vertex_count, const std::string& object,
                 const char* name) {
    if (count != vertex_count)
        file.fail(object, ": ", name, " has ", count, " elements, but POSITION has ", vertex_count);
}

template <int N>
std::vector<Vec<N, float>> read_attribute(const GltfFile& file, const Primitive& primitive, const char* name,
                                          std::size_t vertex_count, const std::string& object) {
    const int accessor = attribute_of(primitive, name);
    if (accessor < 0) return std::vector<Vec<N, float>>(vertex_count, Vec<N, float>(0));
    auto values = read_vectors<N>(file, accessor, text(object, " ", name));
    check_count(file, values.size(), vertex_count, object, name);
    return values;
}

bool has_alpha(const GltfFile& file, int accessor) {
    const auto& accessors = file.model.accessors;
    return std::size_t(accessor) < accessors.size() && accessors[std::size_t(accessor)].type == TINYGLTF_TYPE_VEC4;
}

// With 3 or 4 components, clamped as glTF 2.0 (3.7.2.1) says.
std::vector<vec4> read_colors(GltfFile& file, const Primitive& primitive, std::size_t vertex_count,
                              const std::string& object) {
    std::vector<vec4> colors(vertex_count, vec4(1));
    const int accessor = attribute_of(primitive, "COLOR_0");
    if (accessor < 0) return colors;
    const int components = has_alpha(file, accessor) ? 4 : 3;
    const std::vector<float> values = read_floats(file, accessor, components, object + " COLOR_0");
    const std::size_t width = std::size_t(components);
    check_count(file, values.size() / width, vertex_count, object, "COLOR_0");
    std::size_t unknown = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        unknown += std::isnan(values[i]);
        colors[i / width][int(i % width)] = std::isnan(values[i]) ? 1 : std::clamp(values[i], 0.0f, 1.0f);
    }
    if (unknown) file.warn(text(object, " COLOR_0: ", unknown, " numbers are NaN, and taken as 1"));
    return colors;
}

}  // namespace

int attribute_of(const Primitive& primitive, const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

std::vector<int> accessors_of(const Primitive& primitive) {
    std::vector<int> accessors;
    for (const char* name : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"})
        accessors.push_back(attribute_of(primitive, name));
    for (const auto& [name, accessor] : primitive.attributes)
        if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) accessors.push_back(accessor);
    for (const auto& target : primitive.targets)
        for (const auto& [name, accessor] : target) accessors.push_back(accessor);
    return accessors;
}

VertexLayout vertex_layout(const GltfFile& file, const std::vector<const Primitive*>& primitives,
                           const std::string& object, bool is_skinned) {
    VertexLayout layout;
    layout.tangents = !primitives.empty();
    for (const Primitive* primitive : primitives) {
        const auto has = [&](const char* name) { return attribute_of(*primitive, name) >= 0; };
        layout.normals |= has("NORMAL");
        layout.uvs |= has("TEXCOORD_0");
        layout.second_uvs |= has("TEXCOORD_1");
        layout.colors |= has("COLOR_0");
        // Shading derives tangents where a mesh has none, so all or none is right and a mixture is not.
        layout.tangents &= has("TANGENT") && has("NORMAL");
    }
    layout.motion = motion_layout(file, primitives, object, is_skinned);
    layout.motion.normals &= layout.normals;
    layout.motion.tangents &= layout.tangents;
    return layout;
}

GltfVertices read_gltf_vertices(GltfFile& file, const Primitive& primitive, const VertexLayout& layout,
                                const std::string& object) {
    GltfVertices v;
    v.positions = read_vectors<3>(file, attribute_of(primitive, "POSITION"), object + " POSITION");
    const std::size_t count = v.positions.size();
    const char* second = attribute_of(primitive, "TEXCOORD_1") < 0 ? "TEXCOORD_0" : "TEXCOORD_1";
    if (layout.normals) v.normals = read_attribute<3>(file, primitive, "NORMAL", count, object);
    if (layout.tangents) v.tangents = read_attribute<4>(file, primitive, "TANGENT", count, object);
    if (layout.uvs) v.uvs = read_attribute<2>(file, primitive, "TEXCOORD_0", count, object);
    if (layout.second_uvs) v.second_uvs = read_attribute<2>(file, primitive, second, count, object);
    if (layout.colors) v.colors = read_colors(file, primitive, count, object);
    v.motion = read_gltf_motion(file, primitive, layout.motion, count, object);
    return v;
}

GltfVertices picked(const GltfVertices& all, const std::vector<uint>& vertices) {
    return {picked(all.positions, 1, vertices), picked(all.normals, 1, vertices),    picked(all.tangents, 1, vertices),
            picked(all.uvs, 1, vertices),       picked(all.second_uvs, 1, vertices), picked(all.colors, 1, vertices),
            picked(all.motion, vertices)};
}

void append(Mesh& mesh, VertexMotion& motion, const GltfVertices& vertices) {
    append(mesh.positions, vertices.positions);
    append(mesh.normals, vertices.normals);
    append(mesh.tangents, vertices.tangents);
    append(mesh.uvs, vertices.uvs);
    append(mesh.second_uvs, vertices.second_uvs);
    append(mesh.colors, vertices.colors);
    append(motion, vertices.motion);
}

}  // namespace twinray
