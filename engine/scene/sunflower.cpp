// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include <twinray/geometry.h>
#include <twinray/scene.h>
#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {

constexpr uint bead_count = 1200, color_count = 48;
constexpr float outer_radius = 2.4f, dome_height = 1.0f;

// Deep blue at the heart, over turquoise and cream, to coral at the rim; linear.
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

// The k-th bead of Vogel's spiral (1979): each is a golden angle further, so that all have the same room.
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
