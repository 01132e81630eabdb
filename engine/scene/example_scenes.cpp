// The scenes that twinray makes itself: a Cornell box and a sunflower.
#include <numbers>

#include <twinray/scene.h>
#include "twinray/glsl/cpp.h"

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

constexpr uint bead_count = 1200, color_count = 48;
constexpr float outer_radius = 2.4f, dome_height = 1.0f;

// Returns a linear colour: deep blue at the heart, over turquoise and cream, to coral at the rim.
vec3 petal_color(float along) {
    constexpr vec3 stops[] = {{0.02f, 0.03f, 0.1f},  {0.02f, 0.16f, 0.24f}, {0.10f, 0.46f, 0.42f},
                              {0.86f, 0.72f, 0.42f}, {0.82f, 0.26f, 0.10f}, {0.42f, 0.035f, 0.07f}};
    const float at = along * 4.999f;
    const auto stop = static_cast<uint>(at);
    return mix(stops[stop], stops[stop + 1], at - static_cast<float>(stop));
}

std::vector<Material> sunflower_materials() {
    std::vector<Material> materials;
    for (uint i = 0; i < color_count; ++i)
        materials.push_back({.name = "glazed " + std::to_string(i),
                             .base_color = vec4(petal_color(static_cast<float>(i) / (color_count - 1)), 1),
                             .metallic = 0,
                             .roughness = 0.3f});
    materials.push_back({.name = "gold", .base_color = vec4(1, 0.71f, 0.29f, 1), .metallic = 1, .roughness = 0.45f});
    materials.push_back(
        {.name = "table", .base_color = vec4(0.035f, 0.037f, 0.045f, 1), .metallic = 0, .roughness = 0.5f});
    return materials;
}

Transform placed(float size, vec3 center) {
    return {{vec4(size, 0, 0, center.x), vec4(0, size, 0, center.y), vec4(0, 0, size, center.z)}};
}

// Returns the k-th bead of Vogel's spiral (1979): each is a golden angle further, so that all have the same room.
Instance bead(uint k) {
    const float along = std::sqrt((static_cast<float>(k) + 0.5f) / bead_count), radius = outer_radius * along;
    const float angle = static_cast<float>(k) * std::numbers::pi_v<float> * (3 - std::sqrt(5.0f));
    const float fall = 1 - along * along, dome = dome_height * fall * fall;
    const float size = 0.058f + 0.024f * along;
    const bool is_gold = k % 21 == 4;
    const auto color = static_cast<uint>(along * (color_count - 1) + 0.5f);
    return {.name = "bead " + std::to_string(k),
            .mesh = 0,
            .transform = placed(size, {radius * std::cos(angle), size + dome, radius * std::sin(angle)}),
            .material = is_gold ? color_count : color};
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

Scene sunflower_scene() {
    Scene scene;
    scene.materials = sunflower_materials();
    scene.meshes = {make_icosphere(4), make_quad({-40, 0, -40}, {0, 0, 80}, {80, 0, 0})};
    scene.meshes[0].materials.assign(scene.meshes[0].triangles.size(), color_count);
    scene.meshes[1].materials.assign(2, color_count + 1);
    for (uint k = 0; k < bead_count; ++k) scene.instances.push_back(bead(k));
    scene.instances.push_back({.name = "table", .mesh = 1, .transform = {}, .material = {}});
    constexpr float cosine = 0.8f, sine = 0.6f;  // looking down by 36.9 degrees
    scene.cameras.push_back({.name = "camera",
                             .camera_to_world = {{vec4(1, 0, 0, 0), vec4(0, cosine, sine, 8 * sine + 0.1f),
                                                  vec4(0, -sine, cosine, 8 * cosine)}},
                             .vertical_fov = 0.5f,
                             .aspect = 16.0f / 9,
                             .orthographic_half_height = std::nullopt});
    return scene;
}

}  // namespace twinray
