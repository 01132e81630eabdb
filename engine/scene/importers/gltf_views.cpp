// SPDX-License-Identifier: MIT
// Reads cameras and lights.
#include <cmath>
#include <numbers>

#include "engine/scene/importers/gltf_nodes.h"
#include "engine/scene/rig.h"
#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {

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

std::vector<Rig::Attachment> read_gltf_cameras(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene) {
    const auto& cameras = file.model.cameras;
    std::vector<Rig::Attachment> attachments;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const GltfNode& node = nodes[i];
        const int index = file.model.nodes[node.index].camera;
        if (index == -1) continue;
        if (index < 0 || std::size_t(index) >= cameras.size())
            file.fail(node.name, ": camera ", index, " does not exist; the file has ", cameras.size());
        const tinygltf::Camera& source = cameras[std::size_t(index)];
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
    const auto& lights = file.model.lights;
    std::vector<Rig::Attachment> attachments;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const GltfNode& node = nodes[i];
        const auto& extensions = file.model.nodes[node.index].extensions;
        const tinygltf::Value* extension = find_extension(extensions, "KHR_lights_punctual");
        if (!extension || !find_member(*extension, "light") || !node.is_visible) continue;
        const int index = index_of(*extension, "light");
        if (index < 0 || std::size_t(index) >= lights.size())
            file.fail(node.name, ": light ", index, " does not exist; the file has ", lights.size());
        if (add_light(file, node, lights[std::size_t(index)], scene))
            attachments.push_back({.node = static_cast<std::int32_t>(i)});
    }
    return attachments;
}

}  // namespace twinray
