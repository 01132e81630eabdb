// SPDX-License-Identifier: MIT
// How a glTF file becomes a Scene; each step has a file of its own.
#include "engine/scene/gltf_file.h"
#include "engine/scene/gltf_material.h"
#include "engine/scene/gltf_mesh.h"
#include "engine/scene/gltf_nodes.h"
#include "engine/scene/importers.h"

namespace twinray {
namespace {

// Reads each mesh that an instance places, once, and turns Instance::mesh from glTF's index into the scene's.
// Instances of meshes without triangles are dropped.
void read_placed_meshes(GltfFile& file, Scene& scene) {
    constexpr uint unread = UINT32_MAX, empty = UINT32_MAX - 1;
    const uint default_material = static_cast<uint>(scene.materials.size());
    std::vector<uint> read(file.model.meshes.size(), unread);
    for (Instance& instance : scene.instances) {
        uint& mesh = read[instance.mesh];
        if (mesh == unread) {
            Mesh candidate = read_gltf_mesh(file, instance.mesh, default_material);
            mesh = candidate.triangles.empty() ? empty : static_cast<uint>(scene.meshes.size());
            if (mesh != empty) scene.meshes.push_back(std::move(candidate));
        }
        instance.mesh = mesh;
    }
    std::erase_if(scene.instances, [](const Instance& instance) { return instance.mesh == empty; });
}

}  // namespace

Scene import_gltf(const std::filesystem::path& path) {
    GltfFile file = open_gltf(path);
    Scene scene;
    const std::vector<GltfNode> nodes = flatten_nodes(file);
    scene.instances = read_gltf_instances(file, nodes);
    read_gltf_cameras(file, nodes, scene);
    read_gltf_lights(file, nodes, scene);
    read_gltf_materials(file, scene);
    read_placed_meshes(file, scene);
    scene.warnings = std::move(file.warnings);
    return scene;
}

}  // namespace twinray
