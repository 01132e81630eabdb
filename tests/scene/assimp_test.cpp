// SPDX-License-Identifier: MIT
#include "engine/scene/scene.h"
#include "tests/scene/packed_bytes.h"
#include "tests/scene/temp_dir.h"

namespace twinray::test {
namespace {

const std::string SQUARE_OBJ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
const std::string SQUARE_STL =
    "solid s\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid s\n";

Scene load(const std::string& name, const std::string& content) {
    const TempDir dir;
    return load_scene(dir.write(name, content));
}

std::string load_error(const std::string& name, const std::string& content) {
    const std::string message = error_of([&] { load(name, content); });
    expect_contains(message, name);
    return message;
}

TEST(Assimp, ObjSharesEqualVerticesAgain) {
    const Scene scene = load("a.obj", SQUARE_OBJ);
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].positions.size(), 4u);
    EXPECT_EQ(count_triangles(scene), 2u);
    EXPECT_EQ(scene.instances[0].transform, Transform());
}

TEST(Assimp, VerticesAMillionthApartStayApart) {
    const Scene scene = load("a.obj", "v 0 0 0\nv 1e-6 0 0\nv 0 1e-6 0\nv 1e-6 1e-6 0\nf 1 2 3\nf 2 4 3\n");
    EXPECT_EQ(scene.meshes[0].positions.size(), 4u);
}

TEST(Assimp, PolygonsAreTriangulated) {
    EXPECT_EQ(count_triangles(load("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")), 2u);
}

TEST(Assimp, DegenerateTrianglesStayAndKeepTheirIndex) {
    const Mesh obj = load("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\nf 1 2 3\n").meshes[0];
    ASSERT_EQ(obj.triangles.size(), 2u);
    EXPECT_EQ(obj.triangles[0].x, obj.triangles[0].y);
}

TEST(Assimp, StlSharesVerticesAndDropsFacetNormals) {
    const Mesh mesh = load("a.stl", SQUARE_STL).meshes[0];
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_TRUE(mesh.normals.empty());
}

TEST(Assimp, GzipIsUnpackedForBoth) {
    EXPECT_EQ(count_triangles(load("a.obj.gz", gzip_bytes(SQUARE_OBJ))), 2u);
    EXPECT_EQ(count_triangles(load("a.stl.gz", gzip_bytes(SQUARE_STL))), 2u);
}

TEST(Assimp, DamagedGzipIsNamed) {
    const std::string packed = gzip_bytes(SQUARE_OBJ);
    expect_contains(load_error("a.obj.gz", packed.substr(0, packed.size() - 9)), "gzip data is truncated");
    expect_contains(load_error("a.obj.gz", SQUARE_OBJ), "not valid gzip data");
    expect_contains(load_error("a.obj.gz", ""), "gzip data is truncated");
}

TEST(Assimp, MaterialsAndTexturesComeFromTheMtl) {
    const TempDir dir;
    dir.write("a.mtl",
              "newmtl red\nKd 0.5 0.25 0\nKe 1 2 3\nd 0.5\nmap_Kd skin.png\nnewmtl gone\nmap_Kd sub\\no.png\n");
    dir.write("skin.png", png_bytes(1, 1, 8, 6, "abcd"));
    const Scene scene = load_scene(dir.write("a.obj",
                                             "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                             "usemtl red\nf 1/1 2/2 3/3\nusemtl gone\nf 3/3 2/2 1/1\n"));
    ASSERT_EQ(scene.meshes.size(), 2u);
    const Material& red = scene.materials[scene.meshes[0].material(0)];
    EXPECT_EQ(red.name, "red");
    EXPECT_EQ(red.base_color, vec4(0.5f, 0.25f, 0, 0.5f));
    EXPECT_EQ(red.emission, vec3(1, 2, 3));
    EXPECT_EQ(red.roughness, 1);
    EXPECT_EQ(red.metallic, 0);
    EXPECT_EQ(red.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(scene.images[std::size_t(red.base_color_texture.image)].rgba[0], 'a');
    EXPECT_EQ(scene.meshes[0].uvs[0], vec2(0, 1));  // v up in .obj, down here
    const Material& gone = scene.materials[scene.meshes[1].material(0)];
    EXPECT_EQ(scene.images[std::size_t(gone.base_color_texture.image)].width, 32u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    expect_contains(scene.warnings[0], "sub/no.png': file not found; it is shown as a checkerboard");
}

TEST(Assimp, AnIndexOutOfRangeIsNamed) { expect_contains(load_error("a.obj", "v 0 0 0\nf 1 2 3\n"), "out of range"); }

TEST(Assimp, AFileWithoutFacesIsNamed) {
    expect_contains(load_error("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), "no triangles");
    load_error("a.stl", "solid s\nendsolid s\n");
    load_error("a.obj", "");
}

TEST(Assimp, NonFiniteVerticesStayAndAreCounted) {
    const Scene scene = load("a.obj", "v 0 0 0\nv 1 0 inf\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 1 3 4\n");
    EXPECT_EQ(count_triangles(scene), 2u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    expect_contains(scene.warnings[0], "1 of 2 triangles have a NaN or infinite coordinate");
}

}  // namespace
}  // namespace twinray::test
