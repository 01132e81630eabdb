// SPDX-License-Identifier: MIT
// Layers and volumes of materials as kernels render them.
#include "tests/samples/bsdf_samples.h"
#include "tests/samples/render.h"

namespace twinray::path_tracer {
namespace {

class LayersRender : public test::VulkanTest {};

const vec3 to_camera = normalize(vec3(0, 0.8f, 0.6f)), to_light = normalize(vec3(-0.3f, 0.9f, -0.4f));

// Maps to a floor with its tangent along x.
vec3 local(vec3 w) { return {w.x, -w.z, w.y}; }

vec3 value_of(const Bsdf& bsdf) { return evaluate(bsdf, local(to_camera), local(to_light)).f; }

// Floors side by side in one picture, each with a material and its expected value: a kernel takes seconds to compile.
struct Floors {
    Scene scene = {};
    std::vector<const char*> names = {};
    std::vector<vec3> values = {};

    void add(const char* name, const Material& material, const Bsdf& bsdf) {
        Mesh floor = make_quad({4 * static_cast<float>(names.size()), 0, -5}, {0, 0, 10}, {4, 0, 0});
        floor.uvs.assign(4, vec2(0.5f));
        floor.tangents.assign(4, vec4(1, 0, 0, 1));
        path_tracer::add(scene, floor, material);
        names.push_back(name);
        values.push_back(value_of(bsdf));
    }
    // An image of one texel.
    std::int32_t texel(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a) {
        scene.images.push_back({"texel", 1, 1, {r, g, b, a}});
        return static_cast<std::int32_t>(scene.images.size()) - 1;
    }
};

// Expects the radiance of each floor under a directional light.
void expect_values(Context& context, Floors& floors) {
    floors.scene.lights = {
        {.name = "light", .kind = Light::Kind::directional, .color = vec3(1), .direction = -to_light}};
    const auto count = static_cast<uint>(floors.names.size());
    const vec3 middle(2 * static_cast<float>(count), 0, 0);
    Camera camera = look(middle + 9.0f * to_camera, middle, 1);
    camera.orthographic_half_height = 2;
    RenderSetup setup;
    setup.settings.width = count;
    setup.settings.height = 1;
    setup.settings.samples = 1;
    setup.settings.max_depth = 1;
    setup.settings.filter = FILTER_BOX;  // no pixel sees its neighbours' floors
    setup.settings.camera = camera_rays(camera, static_cast<float>(count));
    const HdrImage picture = render(context, floors.scene, setup);
    for (uint i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(picture.rgb[i][c], floors.values[i][c], 2e-3f * floors.values[i][c])
                << floors.names[i] << ' ' << c;
}

Material plastic_material() {
    return {.name = "plastic", .base_color = {0.8f, 0.4f, 0.2f, 1}, .metallic = 0, .roughness = 0.6f};
}
Bsdf plastic_bsdf() { return opaque_of({0.8f, 0.4f, 0.2f}, 0, 0.6f, 1.5f); }

TEST_F(LayersRender, FactorsReachTheBsdf) {
    Floors floors;
    floors.add("plain", plastic_material(), plastic_bsdf());

    Material material = plastic_material();
    material.specular = 0.5f;
    material.specular_color = {2, 8, 1};
    floors.add("specular", material, with_specular(plastic_bsdf(), vec3(0), 0, 1.5f, 0.5f, {2, 8, 1}));

    material = plastic_material();
    material.clearcoat = 0.75f;
    material.clearcoat_roughness = 0.5f;
    floors.add("coat", material, with_coat(plastic_bsdf(), 0.75f, 0.25f));

    material = plastic_material();
    material.sheen_color = {0.25f, 0.5f, 0.75f};
    material.sheen_roughness = 0.9f;
    floors.add("sheen", material, with_sheen(plastic_bsdf(), {0.25f, 0.5f, 0.75f}, 0.9f));

    for (const float turns : {0.0f, 0.125f, -0.25f}) {
        material = plastic_material();
        material.metallic = 1;
        material.roughness = 0.3f;
        material.anisotropy = 0.8f;
        material.anisotropy_rotation = turns * 2 * PI;
        const Bsdf metal = opaque_of({0.8f, 0.4f, 0.2f}, 1, 0.3f, 1.5f);
        floors.add("grain", material, with_grain(metal, mix(0.09f, 1.0f, 0.64f), turns));
    }
    expect_values(context(), floors);
}

// Only the channel that its extension names gives the right result; the other channels of each texture would not.
TEST_F(LayersRender, TexturesScaleTheirFactor) {
    Floors floors;
    const float half = 128 / 255.0f;
    const std::int32_t red = floors.texel(128, 9, 9, 9), green = floors.texel(9, 128, 9, 9),
                       alpha = floors.texel(9, 9, 9, 128), magenta = floors.texel(255, 0, 255, 9);
    Material material = plastic_material();
    material.specular_texture.image = alpha;
    material.specular_color_texture.image = magenta;
    floors.add("specular", material, with_specular(plastic_bsdf(), vec3(0), 0, 1.5f, half, {1, 0, 1}));

    material = plastic_material();
    material.clearcoat = material.clearcoat_roughness = 1;
    material.clearcoat_texture.image = red;
    material.clearcoat_roughness_texture.image = green;
    floors.add("coat", material, with_coat(plastic_bsdf(), half, half * half));

    // The normal is about (0.6, 0, 0.8) by tangent, bitangent and normal.
    material.clearcoat_normal_texture.image = floors.texel(204, 128, 230, 9);
    const vec3 normal = normalize(vec3(204 / 127.5f - 1, 128 / 127.5f - 1, 230 / 127.5f - 1));
    floors.add("normal of a coat", material, with_coat(plastic_bsdf(), half, half * half, normal));

    material = plastic_material();
    material.sheen_color = vec3(1);
    material.sheen_roughness = 1;
    material.sheen_color_texture.image = magenta;
    material.sheen_roughness_texture.image = alpha;
    floors.add("sheen", material, with_sheen(plastic_bsdf(), {1, 0, 1}, half));

    material = plastic_material();
    material.anisotropy = 1;
    material.anisotropy_texture.image = floors.texel(255, 191, 128, 9);
    Bsdf bsdf = with_grain(plastic_bsdf(), mix(0.36f, 1.0f, half * half), 0);
    bsdf.grain = normalize(vec2(255 / 127.5f - 1, 191 / 127.5f - 1));
    floors.add("grain", material, bsdf);
    expect_values(context(), floors);
}

// Makes a box of a volume without an interface, between the camera and what shines.
Scene box_of(const Material& amber) {
    Scene scene;
    Mesh box = make_box({-1, -1, -1}, {1, 1, 1});
    box.normals.clear();
    add(scene, box, amber);
    return scene;
}

Material amber(vec3 color, float distance) {
    return {.name = "amber",
            .metallic = 0,
            .roughness = 0,
            .transmission = 1,
            .ior = 1,
            .thickness = 1,
            .attenuation_color = color,
            .attenuation_distance = distance};
}

RenderSetup through(float to_z) {
    RenderSetup setup;
    setup.settings.samples = 1;
    setup.settings.width = setup.settings.height = 1;
    setup.settings.camera = camera_rays(look({0.1f, 0.2f, 5}, {0.1f, 0.2f, to_z}, 1e-4f), 1);
    return setup;
}

TEST_F(LayersRender, AVolumeDimsByTheLengthOfTheWay) {
    RenderSetup setup = through(0);
    setup.environment = sky(1);
    const vec3 seen = render(context(), box_of(amber({0.5f, 0.25f, 1}, 4)), setup).rgb[0];
    EXPECT_NEAR(seen.x, std::sqrt(0.5f), 1e-4f);
    EXPECT_NEAR(seen.y, 0.5f, 1e-4f);
    EXPECT_NEAR(seen.z, 1, 1e-6f);
    EXPECT_EQ(render(context(), box_of(amber(vec3(0), 1)), setup).rgb[0], vec3(0));
}

TEST_F(LayersRender, WhatLiesInsideAVolumeIsDimmedByTheWayToIt) {
    Scene scene = box_of(amber(vec3(0.5f), 1));
    add(scene, make_quad({-0.9f, -0.9f, 0.5f}, {1.8f, 0, 0}, {0, 1.8f, 0}), lamp(8));
    EXPECT_NEAR(render(context(), scene, through(0)).rgb[0].x, 8 * std::sqrt(0.5f), 1e-3f);
    // A blended surface on the way is passed without counting the way twice.
    Material veil = lambert(0);
    veil.base_color.w = 0;
    veil.alpha_mode = AlphaMode::blend;
    add(scene, make_quad({-0.9f, -0.9f, 0.75f}, {1.8f, 0, 0}, {0, 1.8f, 0}), veil);
    EXPECT_NEAR(render(context(), scene, through(0)).rgb[0].x, 8 * std::sqrt(0.5f), 1e-3f);
}

// A pane bends nothing, a block of the same surface does: both show the sky tinted, the pane what lies straight behind.
TEST_F(LayersRender, WithoutAThicknessGlassIsAPane) {
    Scene scene;
    Material pane{.name = "pane", .base_color = {0.5f, 1, 0.25f, 1}, .metallic = 0, .roughness = 0, .transmission = 1};
    add(scene, wide_floor(1), pane);
    add(scene, make_quad({-0.01f, 0, -0.01f}, {0, 0, 0.02f}, {0.02f, 0, 0}), lamp(1));
    RenderSetup setup;
    setup.settings.width = setup.settings.height = 8;
    setup.settings.samples = 256;
    setup.settings.camera = camera_rays(look({2, 2, 0}, vec3(0), 1e-4f), 1);
    const double kept = 1 - static_cast<double>(fresnel_dielectric(std::sqrt(0.5f), 1.5f));
    const HdrImage seen = render(context(), scene, setup);
    expect_mean(seen, kept, "pane");
    EXPECT_NEAR(seen.rgb[0].x, 0.5f * seen.rgb[0].y, 1e-5f);
    scene.materials[0].thickness = 1;
    EXPECT_EQ(statistics(render(context(), scene, setup)).mean, 0) << "bent aside";
}

}  // namespace
}  // namespace twinray::path_tracer
