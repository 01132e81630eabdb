// SPDX-License-Identifier: MIT
#include "renderer/stopped_lights.h"

#include <gtest/gtest.h>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "renderer/material_kinds.h"

namespace twinray::path_tracer {
namespace {

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

// A triangle of each.
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

TEST(StoppedLights, AreNamedWithWhatStopsThem) {
    const Glasses all;
    Scene scene = scene_of({all.pane, all.rough, all.thick});
    scene.materials.push_back(all.rough);  // of nothing
    EXPECT_TRUE(stopped_lights(scene).empty()) << "no light without size";
    scene.lights = {{.name = "sun"}};
    const std::vector<std::string> said = stopped_lights(scene);
    ASSERT_EQ(said.size(), 2u);
    EXPECT_EQ(said[0],
              "light of 'sun' cannot pass material 'rough': rough glass scatters it, and no path finds a light without "
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
