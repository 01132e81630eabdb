// SPDX-License-Identifier: MIT
// How a glTF file becomes a Scene; each step has a file of its own.
#include "engine/scene/importers/gltf_file.h"
#include "engine/scene/importers/gltf_material.h"
#include "engine/scene/importers/gltf_nodes.h"
#include "engine/scene/importers/gltf_origin.h"
#include "engine/scene/importers/gltf_rig.h"
#include "engine/scene/importers/gltf_shapes.h"
#include "engine/scene/importers/importers.h"

namespace twinray {

Scene import_gltf(const std::filesystem::path& path, const std::optional<dvec3>& origin) {
    GltfFile file = open_gltf(path);
    Scene scene;
    const std::vector<GltfNode> nodes = flatten_nodes(file);
    Rig rig = read_gltf_rig(file, nodes);
    std::vector<GltfInstance> instances = read_gltf_instances(file, nodes, rig);
    rig.cameras = read_gltf_cameras(file, nodes, scene);
    rig.lights = read_gltf_lights(file, nodes, scene);
    read_gltf_materials(file, scene);
    read_gltf_shapes(file, std::move(instances), scene, rig);
    move_to_origin(origin, scene, rig);
    if (!rig.animations.empty()) scene.rig = std::make_shared<const Rig>(std::move(rig));
    scene.warnings = std::move(file.warnings);
    return scene;
}

}  // namespace twinray
