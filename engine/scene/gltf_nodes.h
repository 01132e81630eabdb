// SPDX-License-Identifier: MIT
// The node hierarchy of a glTF file, flattened.
#pragma once

#include <glm/mat4x4.hpp>

#include "engine/scene/animation.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"

namespace twinray {

// A node of the shown scene, with its place in the world.
struct GltfNode {
    std::size_t index = 0;
    std::string name;  // "node 3 'wheel'", for errors and warnings
    Rig::Node local;   // parent: index into the list that flatten_nodes returns; weights left empty
    glm::dmat4 world;  // kept in float64 down the tree, rounded once where it is used
};

// The default scene's nodes, or where there is none all root nodes with their descendants; parents come first.
// Throws Error naming the node on: a missing child, two parents, a cycle, over 1000 levels, a transform that is not
// finite, not affine or has the wrong number of entries.
std::vector<GltfNode> flatten_nodes(const GltfFile& file);

// Empty lists are neutral. Throws Error naming `object` on wrong lengths and a quaternion of length 0.
Trs read_trs(const GltfFile& file, const std::vector<double>& translation, const std::vector<double>& rotation,
             const std::vector<double>& scale, const std::string& object);

// Rounded to float; throws Error naming `object` when an entry is or becomes infinite or NaN.
Transform rounded_transform(const GltfFile& file, const glm::dmat4& matrix, const std::string& object);

struct GltfInstance {
    Instance instance;     // mesh: the glTF index
    std::size_t node = 0;  // that places it: index into the list of nodes
    int skin = -1;         // glTF index
    Rig::Place place;
};
// One for each placement of a mesh, EXT_mesh_gpu_instancing included. Those with a determinant of exactly 0 are skipped
// with a warning. Nodes do not place what a skin carries: it is in world space already.
std::vector<GltfInstance> read_gltf_instances(GltfFile& file, const std::vector<GltfNode>& nodes);

// Cameras and KHR_lights_punctual that the nodes carry, and by which they are placed.
std::vector<Rig::Place> read_gltf_cameras(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene);
std::vector<Rig::Place> read_gltf_lights(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene);

}  // namespace twinray
