// SPDX-License-Identifier: MIT
// Meshes of glTF, their materials with variants, and the data that move their vertices: morph targets and skins.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <twinray/scene.h>

#include "engine/scene/importers/gltf_accessor.h"
#include "engine/scene/importers/gltf_file.h"
#include "engine/scene/rig.h"

namespace twinray {

// Fills scene.materials, one per glTF material in the same order with its layers KHR_materials_*, and scene.images with
// those that they use, each decoded once. An image that cannot be read becomes a checkerboard, with a warning; a normal
// map that cannot be read is left out.
void read_gltf_materials(GltfFile& file, Scene& scene);

// Names of the file's variants: KHR_materials_variants.
std::vector<std::string> read_variant_names(const GltfFile& file);

// Returns by variant the primitive's material, or -1 if it keeps its own; empty if it has no mapping. Throws Error
// naming `object` on a variant or material that does not exist.
std::vector<int> read_variant_materials(const GltfFile& file, const tinygltf::Primitive& primitive,
                                        const std::string& object);

using GltfAttributes = std::map<std::string, int>;  // of a primitive or a morph target: accessors by name
// Returns an accessor's index, or -1.
int attribute_of(const GltfAttributes& attributes, const std::string& name);
// Throws Error naming `object` and the attribute unless it has an element for each vertex.
void check_element_count(const GltfFile& file, std::size_t count, std::size_t vertex_count, const std::string& object,
                         std::string_view name);

// Returns 0 for each vertex where there is no such attribute.
template <int N>
std::vector<Vec<N, float>> read_attribute(const GltfFile& file, const GltfAttributes& attributes, const char* name,
                                          std::size_t vertex_count, const std::string& object) {
    const int accessor = attribute_of(attributes, name);
    if (accessor < 0) return std::vector<Vec<N, float>>(vertex_count, Vec<N, float>(0));
    auto values = read_vectors<N>(file, accessor, text(object, " ", name));
    check_element_count(file, values.size(), vertex_count, object, name);
    return values;
}

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

// Returns the motion data of some vertices, with `width` values each.
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

// Returns one glTF mesh as one Mesh: the triangles of all its primitives in file order. Primitives without a material
// get the index after the last of `materials`, which are those of the file. Points and lines are skipped with a
// warning; the result may be empty. is_skinned: whether a node with a skin shows it.
GltfMesh read_gltf_mesh(GltfFile& file, std::size_t index, const std::vector<Material>& materials, bool is_skinned);

}  // namespace twinray
