// SPDX-License-Identifier: MIT
#include <twinray/geometry.h>

#include <twinray/scene.h>

namespace twinray {
namespace {

enum CornellMaterial : uint { WHITE, RED, GREEN, LIGHT, METAL, GLASS };

Material diffuse(const char* name, vec3 color) {
    return {.name = name, .base_color = vec4(color, 1), .metallic = 0, .roughness = 1};
}

std::vector<Material> cornell_materials() {
    return {diffuse("white", vec3(0.73f)),
            diffuse("red", {0.65f, 0.05f, 0.05f}),
            diffuse("green", {0.12f, 0.45f, 0.15f}),
            {.name = "light", .base_color = vec4(0, 0, 0, 1), .metallic = 0, .emission = vec3(15, 13.5f, 11)},
            {.name = "metal", .base_color = vec4(0.95f, 0.85f, 0.6f, 1), .metallic = 1, .roughness = 0.15f},
            {.name = "glass", .metallic = 0, .roughness = 0, .transmission = 1, .ior = 1.5f, .thickness = 1}};
}

void add(Scene& scene, Mesh mesh, const char* name, CornellMaterial material, const Transform& transform = {}) {
    mesh.name = name;
    mesh.materials.assign(mesh.triangles.size(), material);
    scene.instances.push_back({name, static_cast<uint>(scene.meshes.size()), transform});
    scene.meshes.push_back(std::move(mesh));
}

Transform turned_about_y(float sine, float cosine, vec3 offset) {
    return {{vec4(cosine, 0, sine, offset.x), vec4(0, 1, 0, offset.y), vec4(-sine, 0, cosine, offset.z)}};
}

}  // namespace

Scene cornell_box_scene() {
    const vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
    Scene scene;
    scene.materials = cornell_materials();
    add(scene, make_quad({-1, -1, -1}, z, x), "floor", WHITE);
    add(scene, make_quad({-1, 1, -1}, x, z), "ceiling", WHITE);
    add(scene, make_quad({-1, -1, -1}, x, y), "back", WHITE);
    add(scene, make_quad({-1, -1, -1}, y, z), "left", RED);
    add(scene, make_quad({1, -1, -1}, z, y), "right", GREEN);
    // It is slightly under the ceiling, whose plane it would otherwise share.
    add(scene, make_quad({-0.25f, 0.995f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f}), "light", LIGHT);
    add(scene, make_box({-0.3f, 0, -0.3f}, {0.3f, 1.2f, 0.3f}), "metal box", METAL,
        turned_about_y(0.28f, 0.96f, {-0.38f, -1, -0.3f}));
    add(scene, make_icosphere(4, 0.35f), "glass sphere", GLASS, Transform::translation({0.4f, -0.65f, 0.35f}));
    scene.cameras.push_back({.name = "camera",
                             .camera_to_world = Transform::translation({0, 0, 3.6f}),
                             .vertical_fov = 0.75f,
                             .aspect = 1.0f,
                             .orthographic_half_height = std::nullopt});
    return scene;
}

}  // namespace twinray
