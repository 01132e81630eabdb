// SPDX-License-Identifier: MIT
// Cameras and lights: what looks at the triangles and shines on them.
#include <cmath>
#include <numbers>

#include "engine/scene/gltf_nodes.h"

namespace twinray {
namespace {

std::string name_or(const std::string& name, const std::string& fallback) { return name.empty() ? fallback : name; }

// The frame without its scale, which glTF keeps from cameras and lights; nothing when an axis has no length.
std::optional<glm::dmat4> unscaled(const glm::dmat4& world) {
    glm::dmat4 frame = world;
    for (int i = 0; i < 3; ++i) {
        const double length = glm::length(world[i]);
        if (!(length > 0)) return std::nullopt;
        frame[i] /= length;
    }
    return frame;
}

// False when the lens cannot form an image.
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

std::optional<Light::Kind> kind_of(const std::string& type) {
    if (type == "directional") return Light::Kind::directional;
    if (type == "point") return Light::Kind::point;
    if (type == "spot") return Light::Kind::spot;
    return std::nullopt;
}

void add_light(GltfFile& file, const GltfNode& node, const tinygltf::Light& source, Scene& scene) {
    const std::optional<Light::Kind> kind = kind_of(source.type);
    const std::optional<glm::dmat4> frame = unscaled(node.world);
    if (!kind || !frame) {
        file.warn(text(node.name, ": skipped its light, ",
                       kind ? "whose frame has no extent" : "of unknown type '" + source.type + "'"));
        return;
    }
    Light light;
    light.name = name_or(source.name, node.name);
    light.kind = *kind;
    if (source.color.size() == 3) light.color = vec3(source.color[0], source.color[1], source.color[2]);
    light.color *= static_cast<float>(source.intensity);
    light.position = vec3((*frame)[3]);
    light.direction = -vec3((*frame)[2]);
    if (source.range > 0) light.range = static_cast<float>(source.range);
    light.inner_cone = static_cast<float>(source.spot.innerConeAngle);
    light.outer_cone = static_cast<float>(source.spot.outerConeAngle);
    scene.lights.push_back(std::move(light));
}

}  // namespace

void read_gltf_cameras(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene) {
    const auto& cameras = file.model.cameras;
    for (const GltfNode& node : nodes) {
        const int index = file.model.nodes[node.index].camera;
        if (index == -1) continue;
        if (index < 0 || std::size_t(index) >= cameras.size())
            file.fail(node.name, ": camera ", index, " does not exist; the file has ", cameras.size());
        const tinygltf::Camera& source = cameras[std::size_t(index)];
        Camera camera;
        camera.name = name_or(source.name, node.name);
        const std::optional<glm::dmat4> frame = unscaled(node.world);
        if (!frame || !set_lens(source, camera)) {
            file.warn(node.name + ": skipped its camera, whose frame or field of view is empty");
            continue;
        }
        camera.camera_to_world = rounded_transform(file, *frame, node.name);
        scene.cameras.push_back(std::move(camera));
    }
}

void read_gltf_lights(GltfFile& file, const std::vector<GltfNode>& nodes, Scene& scene) {
    const auto& lights = file.model.lights;
    for (const GltfNode& node : nodes) {
        const auto& extensions = file.model.nodes[node.index].extensions;
        const tinygltf::Value* extension = find_extension(extensions, "KHR_lights_punctual");
        if (!extension || !find_member(*extension, "light")) continue;
        const int index = index_of(*extension, "light");
        if (index < 0 || std::size_t(index) >= lights.size())
            file.fail(node.name, ": light ", index, " does not exist; the file has ", lights.size());
        add_light(file, node, lights[std::size_t(index)], scene);
    }
}

}  // namespace twinray
