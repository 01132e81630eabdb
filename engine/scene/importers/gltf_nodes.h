// SPDX-License-Identifier: MIT
// The node hierarchy of a glTF file, flattened, with the objects that it carries and the data that move it: morph
// weights, skins, animations.
#pragma once

#include <span>

#include <glm/mat4x4.hpp>

#include <twinray/scene.h>

#include "engine/scene/rig.h"
#include "engine/scene/importers/gltf_file.h"

namespace twinray {

// A node of the shown scene, with its transform to the world.
struct GltfNode {
    std::size_t index = 0;
    std::string name;        // "node 3 'wheel'", for errors and warnings
    Rig::Node local;         // parent: index into the list that flatten_nodes returns; weights left empty
    glm::dmat4 world;        // kept in float64 down the tree, rounded once where it is used
    glm::dmat4 frame;        // as in Pose::frames
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
