// SPDX-License-Identifier: MIT
// Materials of .obj files.
#include <twinray/scene.h>
#include "tests/scene/packed_bytes.h"
#include "tests/scene/temp_dir.h"

namespace twinray::test {
namespace {

const std::string TRIANGLE_WITH_UVS = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

// A triangle of material "a" of a file a.mtl.
Scene load_with_mtl(const std::string& mtl, const std::string& used = "a") {
    const TempDir dir;
    dir.write("a.mtl", mtl);
    dir.write("skin.png", png_bytes(1, 1, 8, 6, "abcd"));
    return load_scene(
        dir.write("a.obj", "mtllib a.mtl\n" + TRIANGLE_WITH_UVS + "usemtl " + used + "\nf 1/1 2/2 3/3\n"));
}

const Material& used_in(const Scene& scene) { return scene.materials[scene.meshes[0].material(0)]; }

vec3 color_of(const std::string& mtl, const std::string& used = "a") {
    return vec3(used_in(load_with_mtl(mtl, used)).base_color);
}

TEST(Mtl, ColoursOpacityAndTexture) {
    const Scene scene = load_with_mtl("newmtl a\nKd 0.5 0.25 0\nKe 1 2 3\nd 0.5\nmap_Kd skin.png\nNs 10\nillum 2\n");
    const Material& material = used_in(scene);
    EXPECT_EQ(material.name, "a");
    EXPECT_EQ(material.base_color, vec4(0.5f, 0.25f, 0, 0.5f));
    EXPECT_EQ(material.emission, vec3(1, 2, 3));
    EXPECT_EQ(material.roughness, 1);
    EXPECT_EQ(material.metallic, 0);
    EXPECT_EQ(material.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(scene.images[std::size_t(material.base_color_texture.image)].rgba[0], 'a');
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
}

TEST(Mtl, LinesAreAsFreeAsInObjFiles) {
    const vec3 orange(0.75f, 0.5f, 0.25f);
    EXPECT_EQ(color_of("\xef\xbb\xbf# paint\r\n\r\n  newmtl a  \r\n\tKd 0.75 0.5 0.25 # orange"), orange);
    EXPECT_EQ(color_of("newmtl red\nKd 1 0 0\nnewmtl red paint\nKd 0.75 0.5 0.25\n", "red paint"), orange);
    EXPECT_EQ(color_of("newmtl Material #25\nKd 0.75 0.5 0.25\nnewmtl Material #26\nKd 0 0 0\n", "Material #25"),
              orange);
    EXPECT_EQ(color_of("newmtl a # paint\nKd 0.5\nKd 0.75 0.5\\\n 0.25\n", "a # so"), orange);
    EXPECT_EQ(color_of("newmtl a\nKd 0.5\n"), vec3(0.5f));
}

TEST(Mtl, TrIsTheOppositeOfDWhichCounts) {
    const auto opacity = [](const std::string& lines) {
        return used_in(load_with_mtl("newmtl a\n" + lines)).base_color.w;
    };
    EXPECT_EQ(opacity("Tr 0.75\n"), 0.25f);
    EXPECT_EQ(opacity("d 1\nTr 1\n"), 1);
    EXPECT_EQ(opacity("Tr 1\nd 1\n"), 1);
    EXPECT_EQ(opacity("d -halo 0.25\n"), 0.25f);
    EXPECT_EQ(opacity("d 2\n"), 1);
    EXPECT_EQ(used_in(load_with_mtl("newmtl a\nd 0.5\nd 1\n")).alpha_mode, AlphaMode::opaque);
}

TEST(Mtl, WithoutAColourItIsGreyOrTheTexture) {
    EXPECT_EQ(color_of("newmtl a\n"), vec3(0.6f));
    EXPECT_EQ(color_of("newmtl a\nmap_Kd skin.png\n"), vec3(1));
    EXPECT_EQ(color_of("newmtl a\nmap_Kd skin.png\nKd 0.5\n"), vec3(0.5f));
}

TEST(Mtl, OptionsOfATextureAreReadOrPassedOver) {
    const Scene scene = load_with_mtl("newmtl a\nmap_Kd -s 2 4 1 -o 0.5 0.25 -clamp on -mm 0 1 -blendu off skin.png\n");
    const Texture& texture = used_in(scene).base_color_texture;
    EXPECT_EQ(texture.uv_row0, vec3(2, 0, 0.5f));
    EXPECT_EQ(texture.uv_row1, vec3(0, 4, 1 - 4 - 0.25f));  // v up in the file: 4 v + 0.25
    EXPECT_EQ(texture.wrap_u, Wrap::clamp_to_edge);
    ASSERT_EQ(scene.warnings.size(), 1u) << joined(scene.warnings);
    expect_contains(scene.warnings[0], "a.mtl': passed over '-blendu' (line 2), '-mm' (line 2)");
}

TEST(Mtl, TexturesAreFoundBesideEitherFile) {
    const TempDir dir;
    std::filesystem::create_directory(dir / "paint");
    dir.write("paint/1 red.png", png_bytes(1, 1, 8, 6, "rgba"));
    dir.write("blue.png", png_bytes(1, 1, 8, 6, "bgra"));
    dir.write("paint/a.mtl",
              "newmtl a\nmap_Kd -s 1 1 1 1 red.png\nnewmtl b\nmap_Kd .\\blue.png\nnewmtl c\nmap_Kd paint\\1 red.png\n");
    const Scene scene =
        load_scene(dir.write("a.obj", "mtllib .\\paint\\a.mtl\nmtllib .\\paint\\a.mtl\n" + TRIANGLE_WITH_UVS +
                                          "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n"));
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
    ASSERT_EQ(scene.materials.size(), 3u);
    const auto first_byte = [&](std::size_t i) {
        return scene.images[std::size_t(scene.materials[i].base_color_texture.image)].rgba[0];
    };
    EXPECT_EQ(first_byte(0), 'r');
    EXPECT_EQ(first_byte(1), 'b');
    EXPECT_EQ(first_byte(2), 'r');
}

TEST(Mtl, SeveralFilesAndBlanksInNames) {
    const TempDir dir;
    dir.write("my paint.mtl", "newmtl a\nKd 0.5\n");
    dir.write("b.MTL", "newmtl b\nKd 0.25\nnewmtl a\nKd 0.125\n");
    const Scene scene =
        load_scene(dir.write("a.obj", "mtllib my paint.mtl b.MTL # both\n" + TRIANGLE_WITH_UVS + "f 1 2 3\n"));
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[0].base_color.x, 0.125f);  // told anew
    EXPECT_EQ(scene.materials[1].base_color.x, 0.25f);
    EXPECT_EQ(scene.materials[2].name, "default");
    EXPECT_EQ(scene.meshes[0].materials, std::vector<uint>{2});
}

// As in a glTF file: in the order of the file, used or not, and nothing before them.
TEST(Mtl, MaterialsKeepTheirOrderAndCutNoMesh) {
    const TempDir dir;
    dir.write("a.mtl", "newmtl a\nnewmtl b\nnewmtl unused\nnewmtl c\n");
    const Scene scene = load_scene(dir.write("a.obj", "mtllib a.mtl\no body\n" + TRIANGLE_WITH_UVS +
                                                          "usemtl c\nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n"));
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
    EXPECT_EQ(scene.meshes[0].materials, (std::vector<uint>{3, 0, 1}));
    EXPECT_EQ(scene.materials.size(), 4u);
}

TEST(Mtl, WhatIsMissingIsNamed) {
    const TempDir dir;
    const Scene scene = load_scene(
        dir.write("a.obj", "mtllib nowhere.mtl\n" + TRIANGLE_WITH_UVS + "usemtl b\nf 1 2 3\nusemtl a\nf 1 2 3\n"));
    EXPECT_EQ(scene.meshes[0].materials, (std::vector<uint>{0, 1}));
    EXPECT_EQ(scene.materials[0].name, "b");
    EXPECT_EQ(scene.materials[0].base_color, vec4(0.6f, 0.6f, 0.6f, 1));
    ASSERT_EQ(scene.warnings.size(), 2u) << joined(scene.warnings);
    expect_contains(scene.warnings[0], "nowhere.mtl': file not found; its materials are missing");
    expect_contains(scene.warnings[1], "no .mtl file of it has are shown grey: 'b' (line 8), 'a' (line 10)");
}

TEST(Mtl, AMissingImageIsACheckerboard) {
    const Scene scene = load_with_mtl("newmtl a\nmap_Kd sub\\no.png\n");
    EXPECT_EQ(scene.images[std::size_t(used_in(scene).base_color_texture.image)].width, 32u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    expect_contains(scene.warnings[0], "sub/no.png': file not found; it is shown as a checkerboard");
}

TEST(Mtl, WhatHasNoUseIsToldOnce) {
    const Scene scene = load_with_mtl(
        "Kd 1 1 1\nnewmtl a\nKd spectral file.rfl\nd\nmap_Bump b.png\nmap_Bump c.png\nmap_Kd\nKe nan 0 0\n");
    EXPECT_EQ(used_in(scene).base_color, vec4(0.6f, 0.6f, 0.6f, 1));
    ASSERT_EQ(scene.warnings.size(), 1u) << joined(scene.warnings);
    expect_contains(
        scene.warnings[0],
        "passed over 'Kd' (line 1), 'Kd spectral' (line 3), 'd ' (line 4), 'map_Bump' (line 5), 'map_Kd' (line 7), "
        "'Ke nan' (line 8)");
}

}  // namespace
}  // namespace twinray::test
