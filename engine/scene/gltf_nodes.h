// SPDX-License-Identifier: MIT
// The node hierarchy of a glTF file, flattened.
#pragma once

#include <glm/mat4x4.hpp>

#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"

namespace twinray {

// A node of the shown scene, with its place in the world.
struct GltfNode {
    std::size_t index = 0;
    std::string name;  // "node 3 'wheel'", for errors and warnings
    glm::dmat4 world;  // kept in float64 down the tree, rounded once where it is used
};

// The default scene's nodes, or where there is none all root nodes with their descendants; parents come first.
// Throws Error naming the node on: a missing child, two parents, a cycle, over 1000 levels, a transform that is not
// finite, not affine or has the wrong number of entries.
std::vector<GltfNode> flatten_nodes(const GltfFile& file);

// Translation, rotation (a quaternion of any length but 0) and scale as a matrix; empty lists are neutral.
glm::dmat4 matrix_of(const GltfFile& file, const std::vector<double>& translation, const std::vector<double>& rotation,
                     const std::vector<double>& scale, const std::string& object);

// Rounded to float; throws Error naming `object` when an entry is or becomes infinite or NaN.
Transform rounded_transform(const GltfFile& file, const glm::dmat4& matrix, const std::string& object);

// One instance for each placement of a mesh, EXT_mesh_gpu_instancing included; Instance::mesh is the glTF index.
// Those with a determinant of exactly 0 are skipped with a warning.
std::vector<Instance> read_gltf_instances(GltfFile& file, const std::vector<GltfNode>& nodes);

// Cameras and KHR_lights_punctual that the nodes carry.
void read_gltf_cameras(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene);
void read_gltf_lights(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene);

}  // namespace twinray
