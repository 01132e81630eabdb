// SPDX-License-Identifier: MIT
// Meshes of glTF, and what moves their vertices: morph targets and skins.
#pragma once

#include <twinray/scene.h>

#include "engine/scene/importers/gltf_file.h"
#include "engine/scene/rig.h"

namespace twinray {

// The motion data of a whole mesh; its primitives give 0 for what they lack.
struct MotionLayout {
    std::size_t targets = 0;
    bool normals = false, tangents = false;  // of targets
    uint influences = 0;                     // joints a vertex
};
// has_*: whether the mesh has them. is_skinned: whether a node with a skin shows it. Throws Error naming the primitive
// that has another number of targets than the first.
MotionLayout motion_layout(const GltfFile& file, const std::vector<const tinygltf::Primitive*>& primitives,
                           const std::string& object, bool is_skinned);

// Reads the vertices of one primitive. Weights are divided by their sum; vertices without any weight follow the first
// joint, with a warning.
VertexMotion read_gltf_motion(GltfFile& file, const tinygltf::Primitive& primitive, const MotionLayout& layout,
                              std::size_t vertex_count, const std::string& object);

template <class T>
void append(std::vector<T>& all, const std::vector<T>& part) {
    all.insert(all.end(), part.begin(), part.end());
}
void append(VertexMotion& all, const VertexMotion& part);

// The motion data of some vertices, with `width` values each.
template <class T>
std::vector<T> picked(const std::vector<T>& values, std::size_t width, const std::vector<uint>& vertices) {
    std::vector<T> result;
    if (values.empty()) return result;
    result.reserve(vertices.size() * width);
    for (const uint vertex : vertices)
        for (std::size_t i = 0; i < width; ++i) result.push_back(values[vertex * width + i]);
    return result;
}
VertexMotion picked(const VertexMotion& motion, const std::vector<uint>& vertices);

// Throws Error naming the vertex where a weight belongs to a joint that the skin does not have.
void check_joints(const GltfFile& file, const VertexMotion& motion, std::size_t joint_count, const std::string& object);

struct GltfMesh {
    Mesh mesh;                                // before morph targets and skin
    VertexMotion motion;                      // of its vertices
    std::vector<std::vector<uint>> variants;  // by variant of KHR_materials_variants, like Mesh::materials; or none
};

// One glTF mesh as one Mesh: the triangles of all its primitives in file order. Primitives without a material get the
// index after the last of `materials`, which are those of the file. Points and lines are skipped with a warning; the
// result may be empty. is_skinned: whether a node with a skin shows it.
GltfMesh read_gltf_mesh(GltfFile& file, std::size_t index, const std::vector<Material>& materials, bool is_skinned);

}  // namespace twinray
