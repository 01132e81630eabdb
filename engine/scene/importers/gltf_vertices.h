// SPDX-License-Identifier: MIT
// The vertices of glTF primitives: their attributes, and what moves them.
#pragma once

#include "engine/scene/importers/gltf_motion.h"
#include "engine/scene/mesh.h"

namespace twinray {

// What a mesh as a whole has.
struct VertexLayout {
    bool normals = false, tangents = false, uvs = false, second_uvs = false, colors = false;
    MotionLayout motion;
};
// is_skinned: whether a node with a skin shows the mesh.
VertexLayout vertex_layout(const GltfFile& file, const std::vector<const tinygltf::Primitive*>& primitives,
                           const std::string& object, bool is_skinned);

// Arrays as those of Mesh.
struct GltfVertices {
    std::vector<vec3> positions, normals;
    std::vector<vec4> tangents;
    std::vector<vec2> uvs, second_uvs;
    std::vector<vec4> colors;
    VertexMotion motion;
};

// Of one primitive. What it lacks of the layout is 0, of colours white, of the second texture coordinates the first.
GltfVertices read_gltf_vertices(GltfFile& file, const tinygltf::Primitive& primitive, const VertexLayout& layout,
                                const std::string& object);

// Of some vertices.
GltfVertices picked(const GltfVertices& all, const std::vector<uint>& vertices);

// Appends to the arrays of a mesh and its motion.
void append(Mesh& mesh, VertexMotion& motion, const GltfVertices& vertices);

// An accessor's index, or -1.
int attribute_of(const tinygltf::Primitive& primitive, const std::string& name);

// All accessors that the vertices are made from.
std::vector<int> accessors_of(const tinygltf::Primitive& primitive);

}  // namespace twinray
