// Colours, second texture coordinates, normals and tangents of vertices as kernels load them.
#include <limits>

#include "tests/samples/render.h"

namespace twinray::path_tracer {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();

// Corners at (-1, -1), (-1, 1), (1, 1) and (1, -1) in x and z; up is +y.
Mesh floor_quad() { return make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}); }

Scene scene_of(const Mesh& mesh, const Material& material) {
    Scene scene;
    add(scene, mesh, material);
    return scene;
}

// Looks from above at the square from -half to half around `at`; -x is right.
RenderSetup from_above(vec2 at, float half, uint width = 1, uint samples = 1) {
    Camera camera = look({at.x, 2, at.y}, {at.x, 0, at.y}, 1);
    camera.orthographic_half_height = half;
    RenderSetup setup;
    setup.settings.width = width;
    setup.settings.height = 1;
    setup.settings.samples = samples;
    setup.settings.filter = FILTER_BOX;
    setup.settings.camera = camera_rays(camera, 1);
    return setup;
}

void expect_near(vec3 found, vec3 expected, float tolerance, const char* what = "") {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << what << ' ' << i;
}

class VertexAttributes : public test::VulkanTest {
  protected:
    // Returns the colour of an unlit surface at a point.
    vec3 seen(const Scene& scene, vec2 at) { return render(context(), scene, from_above(at, 1e-5f)).rgb[0]; }

    // Returns the shading normal at a point.
    vec3 normal_at(const Scene& scene, vec2 at) {
        const RenderSetup setup = from_above(at, 1e-5f);
        const DeviceScene device_scene(context(), scene, collect_lights(scene), nullptr);
        Renderer renderer(context(), device_scene, setup.settings);
        SwTlas accel(context());
        push_scene(accel, scene);
        const FirstSurface first = renderer.first_surfaces(accel)[0];
        EXPECT_EQ(first.count, samples_of_first_surfaces);
        return first.normal / static_cast<float>(first.count);
    }

    // Expects a grey floor to be as bright as it is under an even sky, without noise.
    void expect_half_of_the_sky(const Scene& scene) {
        RenderSetup setup = from_above({0, 0}, 1, 16, 16);
        setup.environment = sky(1);
        setup.settings.strategy = STRATEGY_BSDF;
        for (const vec3& pixel : render(context(), scene, setup).rgb) expect_near(pixel, vec3(0.5f), 1e-5f);
    }
};

Material unlit(vec4 color = vec4(1)) { return {.name = "unlit", .base_color = color, .unlit = true}; }

TEST_F(VertexAttributes, ColoursMultiplyTheBaseColourAndAreLinearBetweenCorners) {
    Mesh mesh = floor_quad();
    mesh.colors = {{0, 0.5f, 1, 1}, {0, 0.5f, 1, 1}, {1, 0.5f, 0, 1}, {1, 0.5f, 0, 1}};
    const HdrImage picture =
        render(context(), scene_of(mesh, unlit({1, 0.5f, 0.25f, 1})), from_above({0, 0}, 1, 8, 64));
    for (uint i = 0; i < 8; ++i) {
        const float x = 1 - (static_cast<float>(i) + 0.5f) / 8;
        expect_near(picture.rgb[i], vec3(x, 0.5f, 1 - x) * vec3(1, 0.5f, 0.25f), 0.01f);
    }
}

// Base colour has 16 bits: it shows what 8 bits cannot tell apart, and the same picture where they can.
TEST_F(VertexAttributes, TexturesKeepSixteenBits) {
    Mesh mesh = floor_quad();
    mesh.uvs.assign(4, vec2(0.5f));
    Scene scene = scene_of(mesh, unlit());
    scene.materials.back().base_color_texture.image = 0;
    scene.images.resize(1);
    const auto shown = [&](std::uint16_t red) {
        scene.images[0] = {.name = "deep", .width = 1, .height = 1, .rgba = {}, .rgba16 = {red, 30000, 60000, 65535}};
        return seen(scene, {0, 0});
    };
    const auto linear = [](double c) { return static_cast<float>(std::pow((c / 65535 + 0.055) / 1.055, 2.4)); };
    expect_near(shown(20000), vec3(linear(20000), linear(30000), linear(60000)), 1.0f / 65535, "as they are");
    EXPECT_GT(shown(20040).x, shown(20000).x + 5.0f / 65535) << "a sixth of a step of 8 bits";
    scene.images[0] = {.name = "flat", .width = 1, .height = 1, .rgba = {78, 117, 233, 255}};
    const vec3 flat = seen(scene, {0, 0});
    scene.images[0] = {
        .name = "deep", .width = 1, .height = 1, .rgba = {}, .rgba16 = {78 * 257, 117 * 257, 233 * 257, 65535}};
    expect_near(seen(scene, {0, 0}), flat, 1.0f / 65535, "of 8 bits");
}

// A mesh with colours is beside one without, and both have one material: kernels have the code, one mesh has no buffer.
TEST_F(VertexAttributes, MeshesWithoutColoursAreAsTheirMaterial) {
    Mesh colored = floor_quad();
    colored.colors.assign(4, vec4(0, 1, 0, 1));
    Scene scene = scene_of(floor_quad(), unlit());
    add(scene, colored, unlit(), Transform::translation({2, 0, 0}));
    scene.meshes[1].materials = scene.meshes[0].materials;
    expect_near(seen(scene, {0.3f, 0.2f}), vec3(1), 0);
    expect_near(seen(scene, {2.3f, 0.2f}), {0, 1, 0}, 0);
}

TEST_F(VertexAttributes, AlphaOfColoursMasks) {
    Mesh mesh = floor_quad();
    mesh.colors = {vec4(0), vec4(0), vec4(1), vec4(1)};
    for (vec4& color : mesh.colors) color = vec4(1, 1, 1, color.w);
    Material material = unlit();
    material.alpha_mode = AlphaMode::mask;
    Scene scene = scene_of(mesh, material);
    add(scene, make_quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}), unlit({1, 0, 0, 1}));
    expect_near(seen(scene, {-0.05f, 0.2f}), {1, 0, 0}, 0);
    expect_near(seen(scene, {0.05f, 0.2f}), vec3(1), 0);
    scene.materials[0].alpha_mode = AlphaMode::opaque;
    expect_near(seen(scene, {-0.05f, 0.2f}), vec3(1), 0);
}

// A lamp is 1 above a floor, both 2 x 2: its alpha scales the light that arrives, however the lamp is found.
TEST_F(VertexAttributes, AlphaOfColoursDimsLampsAndShadows) {
    const double expected = factor_of_square_above;  // of an opaque lamp
    Mesh veil = square_above();
    veil.colors.assign(4, vec4(1, 1, 1, 0.25f));
    Material lamp_of_glass = lamp(1), glass = lambert(0);
    lamp_of_glass.alpha_mode = glass.alpha_mode = AlphaMode::blend;
    Scene scene = scene_of(floor_quad(), lambert(1));
    add(scene, veil, lamp_of_glass);
    RenderSetup setup = of_the_floor();
    setup.settings.samples = 256;
    for (const uint strategy : {STRATEGY_LIGHTS, STRATEGY_BSDF}) {
        setup.settings.strategy = strategy;
        expect_mean(render(context(), scene, setup), 0.25 * expected, "a lamp");
    }
    scene = scene_of(floor_quad(), lambert(1));
    add(scene, veil, glass, Transform::translation({0, -0.25f, 0}));
    add(scene, square_above(), lamp(1));
    setup.settings.strategy = STRATEGY_LIGHTS;
    expect_mean(render(context(), scene, setup), 0.75 * expected, "a shadow");
}

// Makes an image with a red and a green texel.
Image red_and_green() { return {"red and green", 2, 1, {255, 0, 0, 255, 0, 255, 0, 255}}; }

TEST_F(VertexAttributes, EachTextureTakesItsOwnCoordinates) {
    Mesh mesh = floor_quad();
    mesh.uvs.assign(4, vec2(0.25f, 0.5f));
    mesh.second_uvs.assign(4, vec2(0.75f, 0.5f));
    Material material = unlit();
    material.base_color_texture.image = 0;
    Scene scene = scene_of(mesh, material);
    scene.images = {red_and_green()};
    expect_near(seen(scene, {0, 0.3f}), {1, 0, 0}, 0);
    scene.materials[0].base_color_texture.uv_set = 1;
    expect_near(seen(scene, {0, 0.3f}), {0, 1, 0}, 0);
    scene.materials[0].base_color_texture.uv_row0 = vec3(1, 0, 0.5f);
    expect_near(seen(scene, {0, 0.3f}), {1, 0, 0}, 0);
    scene.materials[0].base_color_texture.uv_row0 = vec3(1, 0, 0);
    scene.meshes[0].uvs.clear();
    expect_near(seen(scene, {0, 0.3f}), {0, 1, 0}, 0, "a mesh with the second alone");
    scene.meshes[0].second_uvs.clear();
    scene.meshes[0].uvs.assign(4, vec2(0.75f, 0.5f));
    expect_near(seen(scene, {0, 0.3f}), {0, 1, 0}, 0, "a mesh with the first alone");
}

// Light is chosen by what its texture shows there; it is dark at the first coordinates.
TEST_F(VertexAttributes, LampsShineByTheSecondCoordinates) {
    Mesh mesh = square_above();
    mesh.uvs.assign(4, vec2(0.25f, 0.5f));
    mesh.second_uvs.assign(4, vec2(0.75f, 0.5f));
    Material material = lamp(1);
    material.emission_texture = {.image = 0, .uv_set = 1};
    Scene scene = scene_of(floor_quad(), lambert(1));
    add(scene, mesh, material);
    scene.images = {{"black and white", 2, 1, {0, 0, 0, 255, 255, 255, 255, 255}}};
    const auto density_of_lamp = [&] { return collect_lights(scene, LightChoice::table).densities[1][0]; };
    EXPECT_NEAR(density_of_lamp(), 0.25f, 1e-6f);
    scene.materials[1].emission_texture.uv_set = 0;
    add(scene, mesh, lamp(1));
    EXPECT_LT(density_of_lamp(), 0.01f);
    scene.materials[1].emission_texture.uv_set = 1;
    scene.instances.pop_back();
    expect_mean(render(context(), scene, of_the_floor()), factor_of_square_above, "lamp");
}

TEST_F(VertexAttributes, TheNearestTexelIsShownUnfiltered) {
    Mesh mesh = floor_quad();
    mesh.uvs = {{0, 0.5f}, {0, 0.5f}, {1, 0.5f}, {1, 0.5f}};
    Material material = unlit();
    material.base_color_texture = {.image = 0, .wrap_u = Wrap::clamp_to_edge, .filter = Filter::nearest};
    Scene scene = scene_of(mesh, material);
    scene.images = {red_and_green()};
    expect_near(seen(scene, {-0.02f, 0.3f}), {1, 0, 0}, 0);
    expect_near(seen(scene, {0.02f, 0.3f}), {0, 1, 0}, 0);
    scene.materials[0].base_color_texture.filter = Filter::linear;
    expect_near(seen(scene, {0.02f, 0.3f}), {0.48f, 0.52f, 0}, 1e-3f);
}

TEST_F(VertexAttributes, NormalsWithoutADirectionAreThoseOfTheTriangle) {
    Scene scene = scene_of(floor_quad(), lambert(0.5f));
    for (const vec3 none : {vec3(0), vec3(nan), vec3(infinity, 0, 0), vec3(0, nan, 1)}) {
        scene.meshes[0].normals.assign(4, none);
        expect_near(normal_at(scene, {0.3f, 0.2f}), {0, 1, 0}, 1e-6f);
        expect_half_of_the_sky(scene);
    }
}

// Looks at the middle of the triangle with vertices 0, 1 and 2. Lengths do not count, and a corner without a direction
// takes the triangle's.
TEST_F(VertexAttributes, NormalsOfAnyLengthAreDirections) {
    const vec3 tilted(0.6f, 0.8f, 0), up(0, 1, 0);
    Scene scene = scene_of(floor_quad(), lambert(0.5f));
    const auto expect_normals = [&](const std::vector<vec3>& normals) {
        scene.meshes[0].normals = normals;
        expect_near(normal_at(scene, {-1 / 3.0f, 1 / 3.0f}), normalize(2.0f * tilted + up), 1e-5f);
    };
    for (const vec3 none : {vec3(0), vec3(nan), vec3(0, 0, -infinity)}) expect_normals({none, tilted, tilted, none});
    for (const float length : {1e-30f, 1e-3f, 1e20f, 3e38f}) expect_normals({up * length, tilted, tilted * length, up});
}

// Normals are against the winding, and one vertex has none: the surface is never black.
TEST_F(VertexAttributes, NormalsAgainstTheWindingAreTurned) {
    Scene scene = scene_of(floor_quad(), lambert(0.5f));
    scene.meshes[0].normals = {vec3(nan), vec3(0, -1, 0), vec3(0, -1, 0), vec3(0, -1, 0)};
    expect_half_of_the_sky(scene);
}

// Makes a floor with a normal map of (0.6, 0, 0.8) along the texture's u.
Scene mapped_floor(uint uv_set) {
    Mesh mesh = floor_quad();
    mesh.uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};         // u along x, v along z
    mesh.second_uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};  // u along z, v along -x
    Material material = lambert(0.5f);
    material.normal_texture = {.image = 0, .uv_set = uv_set};
    Scene scene = scene_of(mesh, material);
    scene.images = {{"tilted", 1, 1, {204, 128, 230, 255}}};
    return scene;
}

TEST_F(VertexAttributes, TangentsAreDerivedFromTheCoordinatesOfTheMap) {
    expect_near(normal_at(mapped_floor(0), {0.3f, 0.2f}), {0.6f, 0.8f, 0}, 0.01f);
    Scene scene = mapped_floor(1);
    expect_near(normal_at(scene, {0.3f, 0.2f}), {0, 0.8f, 0.6f}, 0.01f);
    scene.meshes[0].second_uvs.clear();
    expect_near(normal_at(scene, {0.3f, 0.2f}), {0.6f, 0.8f, 0}, 0.01f);
}

TEST_F(VertexAttributes, TangentsWithoutADirectionAreDerived) {
    Scene scene = mapped_floor(0);
    const vec4 along_z(0, 0, 1, -1);
    scene.meshes[0].tangents.assign(4, along_z);
    expect_near(normal_at(scene, {0.3f, 0.2f}), {0, 0.8f, 0.6f}, 0.01f, "tangents of the file");
    for (const vec4 none : {vec4(0), vec4(nan), vec4(0, infinity, 0, 1), vec4(0, 0, 0, -1), vec4(0, 3, 0, 1)}) {
        scene.meshes[0].tangents.assign(4, none);
        expect_near(normal_at(scene, {0.3f, 0.2f}), {0.6f, 0.8f, 0}, 0.01f);
        scene.meshes[0].tangents = {none, along_z, along_z, along_z};
        if (none.y != 3) expect_near(normal_at(scene, {0.3f, 0.2f}), {0, 0.8f, 0.6f}, 0.01f, "one vertex without");
    }
}

TEST_F(VertexAttributes, WhatASceneLacksTakesNoMemory) {
    Mesh mesh = floor_quad();
    const Scene plain = scene_of(mesh, unlit());
    mesh.colors.assign(4, vec4(1));
    mesh.second_uvs.assign(4, vec2(0));
    const Scene colored = scene_of(mesh, unlit());
    const auto bytes = [&](const Scene& scene) {
        return DeviceScene(context(), scene, collect_lights(scene), nullptr).device_bytes();
    };
    // Second coordinates that no texture uses are not stored.
    EXPECT_EQ(bytes(colored), bytes(plain) + 4 * sizeof(vec4));
}

}  // namespace
}  // namespace twinray::path_tracer
