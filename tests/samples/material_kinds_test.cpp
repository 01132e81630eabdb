// Kinds of materials, by their needs of kernels, and the lights without size that materials stop.
#include "renderer/material_kinds.h"

#include <gtest/gtest.h>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "renderer/lights.h"

namespace twinray::path_tracer {
namespace {

constexpr uint alpha = 1u << PT_HAS_ALPHA, textures = 1u << PT_HAS_TEXTURES, glass = 1u << PT_HAS_GLASS;

Material material_with(uint needs) {
    Material material;
    if (needs & alpha) material.alpha_mode = AlphaMode::blend;
    if (needs & textures) material.normal_texture.image = 0;
    if (needs & glass) material.transmission = 0.5f;
    return material;
}

// Makes a quad of each material.
Scene scene_of(const std::vector<Material>& materials) {
    Scene scene;
    scene.materials = materials;
    for (uint i = 0; i < materials.size(); ++i) {
        scene.meshes.push_back(make_quad(vec3(0), {1, 0, 0}, {0, 1, 0}));
        scene.meshes.back().materials.assign(2, i);
        scene.instances.push_back({"quad", i, {}});
    }
    return scene;
}
Scene scene_with(const std::vector<uint>& needs) {
    std::vector<Material> materials;
    for (const uint kind : needs) materials.push_back(material_with(kind));
    return scene_of(materials);
}

TEST(MaterialKinds, MaterialsThatNeedTheSameAreOfOneKind) {
    const MaterialKinds kinds = kinds_of(scene_with({0, glass, 0, textures | glass, glass}));
    EXPECT_EQ(kinds.needs, (std::vector<uint>{0, glass, textures | glass}));
    EXPECT_EQ(kinds.of, (std::vector<uint>{0, 1, 0, 2, 1}));
    EXPECT_EQ(kinds.all_needs(), textures | glass);
}

// Kernels of all kinds sample textures of lights.
TEST(MaterialKinds, AllReadTheTexturesOfLights) {
    Scene scene = scene_with({0, glass, 0});
    scene.materials[2].emission_texture.image = 0;
    EXPECT_EQ(kinds_of(scene).needs, (std::vector<uint>{0, glass, textures}));
    scene.materials[2].emission = vec3(0, 1, 0);
    EXPECT_EQ(kinds_of(scene).needs, (std::vector<uint>{textures, textures | glass}));
}

TEST(MaterialKinds, UnusedMaterialsNeedNothing) {
    Scene scene = scene_with({textures});
    scene.materials.push_back(material_with(glass));
    const MaterialKinds kinds = kinds_of(scene);
    EXPECT_EQ(kinds.needs, std::vector<uint>{textures});
    EXPECT_EQ(kinds.of, (std::vector<uint>{0, 0}));
    EXPECT_EQ(kinds_of(Scene{}).needs, std::vector<uint>{0});
}

TEST(MaterialKinds, ThereAreFewAndEachHasWhatItsMaterialsNeed) {
    const std::vector<uint> needs = {
        0, alpha, textures, glass, alpha | textures, alpha | glass, textures | glass, alpha | textures | glass};
    const MaterialKinds kinds = kinds_of(scene_with(needs));
    ASSERT_EQ(kinds.needs.size(), most_material_kinds);
    std::vector<bool> is_used(kinds.needs.size());
    for (std::size_t i = 0; i < needs.size(); ++i) {
        ASSERT_LT(kinds.of[i], kinds.needs.size());
        is_used[kinds.of[i]] = true;
        EXPECT_EQ(kinds.needs[kinds.of[i]] & needs[i], needs[i]) << "material " << i;
    }
    EXPECT_EQ(is_used, std::vector<bool>(kinds.needs.size(), true));
}

TEST(MaterialKinds, ThoseBecomeOneThatDifferLeast) {
    const uint all = alpha | textures | glass;
    const MaterialKinds kinds = kinds_of(scene_with({0, alpha | textures, all, glass | alpha, textures | glass}));
    EXPECT_EQ(kinds.of[1], kinds.of[2]);
    EXPECT_NE(kinds.of[0], kinds.of[1]);
    EXPECT_NE(kinds.of[3], kinds.of[4]);
}

TEST(MaterialKinds, LayersAreNeeds) {
    EXPECT_EQ(needs_of({.name = "matt", .specular = 0.5f}), 1u << PT_HAS_SPECULAR);
    EXPECT_EQ(needs_of({.name = "paint", .clearcoat = 1}), 1u << PT_HAS_COAT);
    EXPECT_EQ(needs_of({.name = "cloth", .sheen_color = vec3(1)}), 1u << PT_HAS_SHEEN);
    EXPECT_EQ(needs_of({.name = "brushed", .anisotropy = 1}), 1u << PT_HAS_ANISOTROPY);
    EXPECT_EQ(needs_of({.name = "amber", .transmission = 1, .thickness = 1}), glass | 1u << PT_HAS_VOLUME);
    EXPECT_EQ(needs_of({.name = "pane", .transmission = 1, .thickness = 0}), glass);
    const Material mapped{.name = "mapped", .clearcoat = 1, .clearcoat_texture = {.image = 0}};
    EXPECT_EQ(needs_of(mapped), textures | 1u << PT_HAS_COAT);
}

// Colours of meshes are needs of the materials that show them; all kernels need those of lights, where alpha scales the
// light that arrives.
TEST(MaterialKinds, ColorsAreNeedsOfWhatIsSeenOnColoredMeshes) {
    constexpr uint colors = 1u << PT_HAS_COLORS;
    Scene scene = scene_with({0, 0, glass});
    scene.meshes[1].colors.assign(4, vec4(1));
    EXPECT_EQ(kinds_of(scene).needs, (std::vector<uint>{0, colors, glass}));
    scene.instances[1].material = 2;
    EXPECT_EQ(kinds_of(scene).needs, (std::vector<uint>{0, colors | glass}));
    scene = scene_with({0, alpha});
    scene.meshes[1].colors.assign(4, vec4(1));
    scene.materials[1].emission = vec3(1);
    EXPECT_EQ(kinds_of(scene).needs, (std::vector<uint>{alpha | colors}));
}

TEST(MaterialKinds, SecondTextureCoordinatesAreNeedsOfTextures) {
    constexpr uint second = 1u << PT_HAS_SECOND_UVS;
    Scene scene = scene_with({0, textures});
    scene.meshes[0].second_uvs.assign(4, vec2(0));
    scene.meshes[1].second_uvs.assign(4, vec2(0));
    EXPECT_EQ(kinds_of(scene).needs, (std::vector<uint>{0, textures}));
    scene.materials[0].normal_texture.uv_set = 1;  // without an image
    EXPECT_EQ(kinds_of(scene).needs, (std::vector<uint>{0, textures}));
    scene.materials[1].normal_texture.uv_set = 1;
    EXPECT_EQ(kinds_of(scene).needs, (std::vector<uint>{0, textures | second}));
    scene.materials[1].emission = vec3(1);
    scene.materials[1].emission_texture = {.image = 0, .uv_set = 1};
    EXPECT_EQ(kinds_of(scene).needs, (std::vector<uint>{textures | second}));
}

TEST(MaterialKinds, HaveNames) {
    EXPECT_EQ(name_of_needs(0), "plain");
    EXPECT_EQ(name_of_needs(textures | glass), "textures, glass");
    EXPECT_EQ(std::size(material_needs), 10u);
    for (const uint need : material_needs) EXPECT_NE(name_of_needs(1u << need), "plain") << need;
}

Material glass_material(const char* name) { return {.name = name, .metallic = 0, .roughness = 0, .transmission = 1}; }

struct Glasses {
    Material pane = glass_material("pane"), rough = glass_material("rough"), thick = glass_material("thick"),
             combed = glass_material("combed"), mapped = glass_material("mapped"), metal = glass_material("metal"),
             unlit = glass_material("unlit");

    Glasses() {
        rough.roughness = 0.2f;
        thick.thickness = 0.1f;
        combed.anisotropy = 0.5f;
        mapped.roughness = 1;
        mapped.metallic = 1;
        mapped.metallic_roughness_texture.image = 0;
        metal.metallic = 1;
        unlit.unlit = true;
    }
};

TEST(MaterialKinds, TellPanesFromOtherGlass) {
    const Glasses all;
    for (const Material& material : {all.pane, all.mapped}) EXPECT_TRUE(may_be_pane(material)) << material.name;
    for (const Material& material : {all.rough, all.thick, all.metal, all.unlit, Material{}})
        EXPECT_FALSE(may_be_pane(material)) << material.name;
    for (const Material& material : {all.rough, all.thick, all.combed, all.mapped})
        EXPECT_TRUE(may_be_other_glass(material)) << material.name;
    for (const Material& material : {all.pane, all.metal, all.unlit, Material{}})
        EXPECT_FALSE(may_be_other_glass(material)) << material.name;
}

TEST(StoppedLights, AreNamedWithWhatStopsThem) {
    const Glasses all;
    Scene scene = scene_of({all.pane, all.rough, all.thick});
    scene.materials.push_back(all.rough);  // used by nothing
    EXPECT_TRUE(stopped_lights(scene).empty()) << "no light without size";
    scene.lights = {{.name = "sun"}};
    const std::vector<std::string> said = stopped_lights(scene);
    ASSERT_EQ(said.size(), 2u);
    EXPECT_EQ(
        said[0],
        "light of 'sun' cannot pass material 'rough': rough glass scatters it, and no path can reach a light without "
        "size");
    EXPECT_NE(said[1].find("'thick': the boundary of a volume bends it"), std::string::npos) << said[1];
    scene.lights = {{.name = "sun"}, {.name = "bulb"}, {.name = "lamp"}};
    EXPECT_NE(stopped_lights(scene)[0].find("light of 'sun' and 2 others cannot"), std::string::npos);
    scene = scene_of({all.pane, Material{}});
    scene.lights = {{.name = "sun"}};
    EXPECT_TRUE(stopped_lights(scene).empty()) << "panes let it pass";
}

}  // namespace
}  // namespace twinray::path_tracer
