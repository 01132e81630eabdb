// Reads the objects that nodes carry: instances of meshes, cameras and lights.
#include <numbers>

#include "engine/scene/importers/gltf_parts.h"

namespace twinray {
namespace {

// The matrices of EXT_mesh_gpu_instancing, or one identity.
class Placements {
  public:
    Placements(const GltfFile& file, const GltfNode& node) : file_(file), name_(node.name) {
        const auto& extensions = file.model.nodes[node.index].extensions;
        const tinygltf::Value* extension = find_extension(extensions, "EXT_mesh_gpu_instancing");
        const tinygltf::Value* attributes = extension ? find_member(*extension, "attributes") : nullptr;
        if (!attributes) return;
        translations_ = read<3>(*attributes, "TRANSLATION");
        rotations_ = read<4>(*attributes, "ROTATION");
        scales_ = read<3>(*attributes, "SCALE");
    }

    std::size_t count() const { return count_.value_or(1); }
    bool is_instanced() const { return count_.has_value(); }

    glm::dmat4 matrix(std::size_t i) const {
        return matrix_of(read_trs(file_, entry(translations_, i), entry(rotations_, i), entry(scales_, i),
                                  text(name_, " instance ", i)));
    }

  private:
    template <int N>
    std::vector<Vec<N, float>> read(const tinygltf::Value& attributes, const char* name) {
        const int accessor = index_of(attributes, name);
        if (accessor < 0) return {};
        auto values = read_vectors<N>(file_, accessor, text(name_, " EXT_mesh_gpu_instancing ", name));
        if (count_ && *count_ != values.size())
            file_.fail(name_, ": EXT_mesh_gpu_instancing ", name, " has ", values.size(), " elements, others have ",
                       *count_);
        count_ = values.size();
        return values;
    }

    template <int N>
    static std::vector<double> entry(const std::vector<Vec<N, float>>& values, std::size_t i) {
        std::vector<double> numbers;
        if (!values.empty())
            for (std::size_t k = 0; k < N; ++k) numbers.push_back(values[i][k]);
        return numbers;
    }

    const GltfFile& file_;
    std::string name_;
    std::optional<std::size_t> count_;
    std::vector<vec3> translations_, scales_;
    std::vector<vec4> rotations_;
};

// The effects of animations on a node, by themselves or through a node above it.
struct Driven {
    bool is_scaled = false, is_turned = false;
};

// Returns the effects for each node.
std::vector<Driven> driven_nodes(const Rig& rig) {
    std::vector<Driven> driven(rig.nodes.size());
    for (const Animation& animation : rig.animations)
        for (const Animation::Channel& channel : animation.channels) {
            driven[channel.node].is_scaled |= channel.path == Animation::Channel::Path::scale;
            driven[channel.node].is_turned |= channel.path == Animation::Channel::Path::rotation;
        }
    for (std::size_t i = 0; i < driven.size(); ++i)
        if (const std::int32_t parent = rig.nodes[i].parent; parent >= 0) {
            driven[i].is_scaled |= driven[std::size_t(parent)].is_scaled;
            driven[i].is_turned |= driven[std::size_t(parent)].is_turned;
        }
    return driven;
}

bool has_no_inverse(const Transform& transform) { return !fault_of(transform).empty(); }

void add_instances(GltfFile& file, const std::vector<GltfNode>& nodes, std::size_t index, Driven driven,
                   std::vector<GltfInstance>& instances) {
    const GltfNode& node = nodes[index];
    const tinygltf::Node& source = file.model.nodes[node.index];
    file.entry(file.model.meshes, source.mesh, node.name, "mesh");
    const Placements placements(file, node);
    std::size_t singular = 0;
    for (std::size_t i = 0; i < placements.count(); ++i) {
        const std::string object = placements.is_instanced() ? text(node.name, " instance ", i) : node.name;
        const bool is_skinned = source.skin >= 0;
        GltfInstance found;
        found.node = index;
        found.skin = source.skin;
        found.attachment = {is_skinned ? -1 : static_cast<std::int32_t>(index), placements.matrix(i)};
        found.instance.name = source.name.empty() ? object : source.name;
        found.instance.mesh = static_cast<uint>(source.mesh);
        const glm::dmat4 placed = is_skinned ? found.attachment.local : node.world * found.attachment.local;
        if (const std::optional<FlatPlacement> flat = flat_placement_of(placed);
            flat && !driven.is_scaled && !driven.is_turned) {
            found.lost = flat->lost;
            found.attachment.thickness = 1;
        }
        found.instance.transform = rounded_transform(file, thickened(placed, found.attachment.thickness), object);
        if (has_no_inverse(found.instance.transform)) {
            const Transform local = rounded_transform(file, thickened(found.attachment.local, 1), object);
            if (!driven.is_scaled || has_no_inverse(local)) {
                ++singular;
                continue;
            }
            found.is_hidden = true;
            found.instance.transform = {};
        }
        instances.push_back(std::move(found));
    }
    if (singular)
        file.warn(text(node.name, ": skipped ", singular, " of ", placements.count(),
                       " placements, whose transform leaves the mesh no area"));
}

std::string name_or(const std::string& name, const std::string& fallback) { return name.empty() ? fallback : name; }

// Returns false if the lens cannot form an image.
bool set_lens(const tinygltf::Camera& source, Camera& camera) {
    if (source.type == "orthographic") {
        camera.orthographic_half_height = static_cast<float>(std::abs(source.orthographic.ymag));
        if (!(*camera.orthographic_half_height > 0)) return false;
        const double aspect = std::abs(source.orthographic.xmag / source.orthographic.ymag);
        if (aspect > 0) camera.aspect = static_cast<float>(aspect);
        return true;
    }
    camera.vertical_fov = static_cast<float>(source.perspective.yfov);
    if (source.perspective.aspectRatio > 0) camera.aspect = static_cast<float>(source.perspective.aspectRatio);
    return camera.vertical_fov > 0 && camera.vertical_fov < std::numbers::pi_v<float>;
}

std::optional<Light::Kind> light_kind_of(const std::string& type) {
    if (type == "directional") return Light::Kind::directional;
    if (type == "point") return Light::Kind::point;
    if (type == "spot") return Light::Kind::spot;
    return std::nullopt;
}

// Returns false if it was skipped.
bool add_light(GltfFile& file, const GltfNode& node, const tinygltf::Light& source, Scene& scene) {
    const std::optional<Light::Kind> kind = light_kind_of(source.type);
    const std::optional<glm::dmat4> frame = unscaled(node.frame);
    if (!kind || !frame) {
        file.warn(text(node.name, ": skipped its light, ",
                       kind ? "whose frame has no extent" : "of unknown type '" + source.type + "'"));
        return false;
    }
    Light light;
    light.name = name_or(source.name, node.name);
    light.kind = *kind;
    if (source.color.size() == 3) light.color = vec3(source.color[0], source.color[1], source.color[2]);
    light.color *= static_cast<float>(source.intensity);
    place_light(light, *frame);
    if (source.range > 0) light.range = static_cast<float>(source.range);
    light.inner_cone = static_cast<float>(source.spot.innerConeAngle);
    light.outer_cone = static_cast<float>(source.spot.outerConeAngle);
    scene.lights.push_back(std::move(light));
    return true;
}

}  // namespace

std::vector<GltfInstance> read_gltf_instances(GltfFile& file, const std::vector<GltfNode>& nodes, const Rig& rig) {
    const std::vector<Driven> driven = driven_nodes(rig);
    std::vector<GltfInstance> instances;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (file.model.nodes[nodes[i].index].mesh != -1 && nodes[i].is_visible)
            add_instances(file, nodes, i, driven[i], instances);
    return instances;
}

std::vector<Rig::Attachment> read_gltf_cameras(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene) {
    std::vector<Rig::Attachment> attachments;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const GltfNode& node = nodes[i];
        const int index = file.model.nodes[node.index].camera;
        if (index == -1) continue;
        const tinygltf::Camera& source = file.entry(file.model.cameras, index, node.name, "camera");
        Camera camera;
        camera.name = name_or(source.name, node.name);
        const std::optional<glm::dmat4> frame = unscaled(node.frame);
        if (!frame || !set_lens(source, camera)) {
            file.warn(node.name + ": skipped its camera, whose frame or field of view is empty");
            continue;
        }
        camera.camera_to_world = rounded_transform(file, *frame, node.name);
        scene.cameras.push_back(std::move(camera));
        attachments.push_back({.node = static_cast<std::int32_t>(i)});
    }
    return attachments;
}

std::vector<Rig::Attachment> read_gltf_lights(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene) {
    std::vector<Rig::Attachment> attachments;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const GltfNode& node = nodes[i];
        const auto& extensions = file.model.nodes[node.index].extensions;
        const tinygltf::Value* extension = find_extension(extensions, "KHR_lights_punctual");
        if (!extension || !find_member(*extension, "light") || !node.is_visible) continue;
        const int index = index_of(*extension, "light");
        if (add_light(file, node, file.entry(file.model.lights, index, node.name, "light"), scene))
            attachments.push_back({.node = static_cast<std::int32_t>(i)});
    }
    return attachments;
}

}  // namespace twinray
