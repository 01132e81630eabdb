// The parts of a glTF file: meshes, their materials with variants, the node hierarchy, flattened, with the objects that
// it carries, and the data that move them: morph targets and weights, skins, animations.
#pragma once

#include <map>

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

// A node of the shown scene, with its transform to the world.
struct GltfNode {
    std::size_t index = 0;
    std::string name;        // "node 3 'wheel'", for errors and warnings
    Rig::Node local;         // parent: index into the list that flatten_nodes returns; weights left empty
    glm::dmat4 world;        // kept in float64 down the tree, rounded once where it is used
    glm::dmat4 frame;        // as in Pose::Nodes::frames
    bool is_visible = true;  // by KHR_node_visibility, its own and that of all nodes above
};

// Returns the nodes of the default scene, else of the first one, or if there are no scenes all root nodes, with their
// descendants; parents come first. Warns if a scene had to be chosen, and of a node with two parents, which stays with
// the first. Throws Error naming the node on: a missing child, a cycle, over 1000 levels, a transform that is not
// finite, not affine or has the wrong number of entries.
std::vector<GltfNode> flatten_nodes(GltfFile& file);

// Returns a matrix by its 16 entries, column after column. Its last row, 0 0 0 1 but for rounding, becomes that, and
// the others are divided by its last entry. Throws Error naming `object` if the last row is another one.
glm::dmat4 affine_matrix(const GltfFile& file, std::span<const double, 16> entries, const std::string& object);

// Empty lists are neutral. Throws Error naming `object` on wrong lengths and a quaternion of length 0.
Trs read_trs(const GltfFile& file, const std::vector<double>& translation, const std::vector<double>& rotation,
             const std::vector<double>& scale, const std::string& object);

// Rounds to float; throws Error naming `object` if an entry is or becomes infinite or NaN.
Transform rounded_transform(const GltfFile& file, const glm::dmat4& matrix, const std::string& object);

// Reads nodes with their morph weights, skins and animations. Skins have the file's indices; those that no shown node
// uses have no joints. Throws Error naming a node's weights or skin that cannot be used. For animations that cannot be
// played, Animation::fault and a warning say why.
Rig read_gltf_rig(GltfFile& file, const std::vector<GltfNode>& nodes);
// Reads its animations. flat: the index into `nodes` by the file's index of a node, -1 for one that is not shown.
std::vector<Animation> read_gltf_animations(GltfFile& file, const Rig& rig, const std::vector<std::int32_t>& flat);

struct GltfInstance {
    Instance instance;     // mesh: the glTF index
    std::size_t node = 0;  // that carries it: index into the list of nodes
    int skin = -1;         // glTF index
    Rig::Attachment attachment;
    bool is_hidden = false;  // as Rig::Hidden; its transform is then the identity
    // The mesh is flattened along this; none where its placement has an inverse, and where an animation may give it one
    // or turns what is flat.
    std::optional<dvec3> lost;
};
// Returns one for each placement of a mesh by a visible node, EXT_mesh_gpu_instancing included. Placements that leave
// no area are hidden if an animation of the rig scales their node or one above, else skipped with a warning.
// Nodes do not move a skinned mesh: it is in world space already.
std::vector<GltfInstance> read_gltf_instances(GltfFile& file, const std::vector<GltfNode>& nodes, const Rig& rig);

// Reads cameras of all nodes and KHR_lights_punctual of visible ones, and the nodes that carry them.
std::vector<Rig::Attachment> read_gltf_cameras(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene);
std::vector<Rig::Attachment> read_gltf_lights(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene);

}  // namespace twinray
