// Turns a glTF file into a Scene: here its meshes by the shape that skins and morph targets give them; the other
// steps are in gltf_*.cpp.
#include <set>

#include "engine/scene/importers/gltf_parts.h"
#include "engine/scene/importers/importers.h"

namespace twinray {
namespace {

constexpr uint EMPTY = UINT32_MAX;  // a mesh without triangles

// These decide the shape of a glTF mesh.
struct Shape {
    uint mesh = 0;
    int skin = -1;
    std::vector<double> weights = {};  // of morph targets, at rest
    std::int32_t driver = -1;          // the node whose weights an animation drives; -1: none does
    std::array<double, 3> lost = {};   // the direction along which it is flattened; 0: it is not

    auto operator<=>(const Shape&) const = default;
};

std::set<uint> nodes_with_driven_weights(const Rig& rig) {
    std::set<uint> nodes;
    for (const Animation& animation : rig.animations)
        for (const Animation::Channel& channel : animation.channels)
            if (channel.path == Animation::Channel::Path::weights) nodes.insert(channel.node);
    return nodes;
}

class ShapeReader {
  public:
    ShapeReader(GltfFile& file, const std::vector<GltfInstance>& instances, Scene& scene, Rig& rig)
        : file_(file), scene_(scene), rig_(rig), rest_(rest_pose(rig)), driven_(nodes_with_driven_weights(rig)) {
        for (const std::string& name : read_variant_names(file)) scene_.variants.push_back({name, {}});
        for (const GltfInstance& found : instances) {
            if (found.skin >= 0) skinned_.insert(found.instance.mesh);
            if (found.lost) flattened_.insert(found.instance.mesh);
        }
    }

    // Returns the scene's index of the mesh, or EMPTY.
    uint mesh_of(const GltfInstance& found) {
        Shape shape{found.instance.mesh, found.skin};
        shape.weights = rig_.nodes[found.node].weights;
        if (found.lost) shape.lost = {found.lost->x, found.lost->y, found.lost->z};
        if (driven_.contains(static_cast<uint>(found.node))) shape.driver = static_cast<std::int32_t>(found.node);
        const auto [known, is_new] = shapes_.try_emplace(shape, EMPTY);
        if (is_new) known->second = read(shape, static_cast<uint>(found.node));
        return known->second;
    }

  private:
    uint read(const Shape& shape, uint node) {
        const auto [known, is_new] = sources_.try_emplace(shape.mesh);
        GltfMesh& source = known->second;
        if (is_new) source = read_gltf_mesh(file_, shape.mesh, scene_.materials, skinned_.contains(shape.mesh));
        if (source.mesh.triangles.empty()) return EMPTY;
        const uint mesh = static_cast<uint>(scene_.meshes.size());
        for (std::size_t i = 0; i < source.variants.size(); ++i)
            scene_.variants[i].parts.push_back({mesh, source.variants[i]});
        const bool is_shared = skinned_.contains(shape.mesh) || flattened_.contains(shape.mesh);
        if (shape.skin >= 0 || !source.motion.targets.empty())
            add_deformed(shape.lost == Shape().lost ? source : flattened(source, shape.lost), shape, mesh, node);
        else
            scene_.meshes.push_back(shape.lost != Shape().lost ? flattened(source, shape.lost).mesh
                                    : is_shared                ? source.mesh
                                                               : std::move(source.mesh));
        return mesh;
    }

    static GltfMesh flattened(GltfMesh mesh, const std::array<double, 3>& direction) {
        const dvec3 lost(direction[0], direction[1], direction[2]);
        flatten_along(mesh.mesh, lost);
        for (MorphTarget& target : mesh.motion.targets) {
            flatten_positions(target.positions, lost);
            target.normals.clear(), target.tangents.clear();
        }
        return mesh;
    }

    void add_deformed(const GltfMesh& source, const Shape& shape, uint mesh, uint node) {
        DeformedMesh moving{mesh, node, shape.skin, {}, source.motion};
        Mesh shown = source.mesh;
        if (shape.skin < 0) moving.motion.influences = 0, moving.motion.joints.clear(), moving.motion.weights.clear();
        moving.base = {shown.positions, shown.normals, shown.tangents};
        if (shape.skin >= 0)
            check_joints(file_, moving.motion, rig_.skins[std::size_t(shape.skin)].joints.size(),
                         gltf_name("mesh", shape.mesh, file_.model.meshes[shape.mesh].name));
        set_vertices(shown, deformed(rig_, moving, rest_));
        scene_.meshes.push_back(std::move(shown));
        rig_.meshes.push_back(std::move(moving));
    }

    GltfFile& file_;
    Scene& scene_;
    Rig& rig_;
    Pose rest_;
    std::set<uint> driven_, skinned_, flattened_;  // nodes; meshes of the file
    std::map<uint, GltfMesh> sources_;
    std::map<Shape, uint> shapes_;
};

// Reads each mesh that an instance places, once for each shape that skin and morph weights give it, in the rest pose,
// and with it scene.instances, scene.variants, rig.instances, rig.hidden and rig.meshes. Instances of meshes without
// triangles are dropped.
void read_gltf_shapes(GltfFile& file, std::vector<GltfInstance> instances, Scene& scene, Rig& rig) {
    ShapeReader reader(file, instances, scene, rig);
    for (GltfInstance& found : instances) {
        look_for_interruption();
        found.instance.mesh = reader.mesh_of(found);
    }
    std::erase_if(instances, [](const GltfInstance& found) { return found.instance.mesh == EMPTY; });
    std::ranges::stable_sort(instances, {}, [](const GltfInstance& found) { return found.instance.mesh; });
    for (GltfInstance& found : instances) {
        if (found.is_hidden) {
            rig.hidden.push_back({std::move(found.instance), found.attachment});
            continue;
        }
        scene.instances.push_back(std::move(found.instance));
        rig.instances.push_back(found.attachment);
    }
}

}  // namespace

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
