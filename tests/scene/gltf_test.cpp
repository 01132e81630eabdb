// The geometry of glTF files; gltf_material_test.cpp and gltf_fault_test.cpp test the rest.
#include "tests/scene/gltf_builder.h"

namespace twinray::test {
namespace {

TEST(Gltf, ATriangleKeepsItsNamesPositionsAndIndices) {
    const Scene scene = one_triangle().load();
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].name, "tri");
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}}));
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].name, "node");
    EXPECT_EQ(scene.instances[0].transform, Transform());
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Gltf, GlbHoldsTheSameScene) {
    const Scene scene = load_text(one_triangle().as_glb(), "test.glb");
    EXPECT_EQ(scene.meshes[0].positions, one_triangle().load().meshes[0].positions);
}

TEST(Gltf, AGlbIsKnownByItsContent) {
    EXPECT_EQ(count_triangles(load_text(one_triangle().as_glb(), "misnamed.GLTF")), 1u);
}

TEST(Gltf, BuffersLieInFilesWithEscapedNamesAndMayBeLonger) {
    const TempDir dir;
    GltfBuilder gltf = one_triangle();
    dir.write("my data.bin", gltf.buffer + "trailing");
    gltf.root["buffers"] = {{{"byteLength", gltf.buffer.size()}, {"uri", "my%20data.bin"}}};
    EXPECT_EQ(count_triangles(load_scene(dir.write("test.gltf", gltf.root.dump()))), 1u);
}

TEST(Gltf, IndicesMayHave8Or16Or32Bits) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["indices"] = gltf.add<std::uint8_t>("SCALAR", 5121, {2, 1, 0});
    EXPECT_EQ(gltf.load().meshes[0].triangles[0], uvec3(2, 1, 0));
    gltf.primitive()["indices"] = gltf.add<std::uint16_t>("SCALAR", 5123, {1, 2, 0});
    EXPECT_EQ(gltf.load().meshes[0].triangles[0], uvec3(1, 2, 0));
    gltf.primitive()["indices"] = gltf.add<std::uint32_t>("SCALAR", 5125, {0, 2, 1});
    EXPECT_EQ(gltf.load().meshes[0].triangles[0], uvec3(0, 2, 1));
}

TEST(Gltf, WithoutIndicesVerticesFollowEachOther) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive().erase("indices");
    EXPECT_EQ(gltf.load().meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}}));
}

TEST(Gltf, StripsAndFansKeepTheWindingOfTheSpecification) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive() = {{"attributes", {{"POSITION", gltf.add_floats("VEC3", std::vector<float>(15))}}}, {"mode", 5}};
    EXPECT_EQ(gltf.load().meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
    gltf.primitive()["mode"] = 6;
    EXPECT_EQ(gltf.load().meshes[0].triangles, (std::vector<uvec3>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
}

TEST(Gltf, PointsAndLinesAreSkippedWithACount) {
    GltfBuilder gltf = one_triangle();
    for (const int mode : {0, 1, 3}) {
        json other = gltf.primitive();
        other["mode"] = mode;
        gltf.root["meshes"][0]["primitives"].push_back(other);
    }
    const Scene scene = gltf.load();
    EXPECT_EQ(count_triangles(scene), 1u);
    EXPECT_TRUE(has_warning(scene, "skipped 3 primitives"));
}

TEST(Gltf, CornersAfterTheLastWholeTriangleAreIgnoredWithAWarning) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["indices"] = gltf.add_indices({0, 1, 2, 0, 1});
    const Scene scene = gltf.load();
    EXPECT_EQ(count_triangles(scene), 1u);
    EXPECT_TRUE(has_warning(scene, "ignored 2 vertices"));
}

TEST(Gltf, DegenerateTrianglesStayAndKeepTheirIndex) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["indices"] = gltf.add_indices({0, 0, 1, 0, 1, 2});
    EXPECT_EQ(gltf.load().meshes[0].triangles, (std::vector<uvec3>{{0, 0, 1}, {0, 1, 2}}));
}

TEST(Gltf, AllPrimitivesOfAMeshBecomeOneMeshWithMaterialsPerTriangle) {
    GltfBuilder gltf = one_triangle();
    gltf.root["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
    json other = gltf.primitive();
    other["attributes"]["POSITION"] = gltf.add_floats("VEC3", {0, 0, 1, 1, 0, 1, 0, 1, 1});
    other["material"] = 1;
    gltf.root["meshes"][0]["primitives"].push_back(other);
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(scene.meshes[0].materials, (std::vector<uint>{2, 1}));  // 2: the default, after the file's own
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[2].name, "default");
}

TEST(Gltf, VerticesThatPrimitivesShareAreStoredOnce) {
    GltfBuilder gltf = one_triangle();
    json other = gltf.primitive();
    other["indices"] = gltf.add_indices({2, 1, 0});
    gltf.root["meshes"][0]["primitives"].push_back(other);
    const Mesh mesh = gltf.load().meshes[0];
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {2, 1, 0}}));
}

TEST(Gltf, AMeshThatTwoNodesUseIsLoadedOnce) {
    GltfBuilder gltf = one_triangle();
    gltf.add_node({{"mesh", 0}, {"translation", {1, 2, 3}}});
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.meshes.size(), 1u);
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.instances[1].transform, Transform::translation({1, 2, 3}));
    EXPECT_EQ(count_triangles(scene), 2u);
}

TEST(Gltf, AccessorsHonourOffsetAndStride) {
    GltfBuilder gltf = one_triangle();
    const int accessor = gltf.add_floats("VEC3", {9, 0, 0, 0, 7, 1, 0, 0, 7, 0, 1, 0});
    gltf.root["accessors"][std::size_t(accessor)].update({{"byteOffset", 4}, {"count", 3}});
    gltf.root["bufferViews"].back()["byteStride"] = 16;
    gltf.primitive()["attributes"]["POSITION"] = accessor;
    EXPECT_EQ(gltf.load().meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

// If the file gives no stride, the length of the view tells it; a longer view says nothing.
TEST(Gltf, PaddedVectorsWithoutAStrideAreReadAsTheyLie) {
    GltfBuilder gltf = one_triangle();
    const int accessor = gltf.add<std::uint16_t>("VEC4", 5123, {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0});
    gltf.root["accessors"][std::size_t(accessor)]["type"] = "VEC3";
    gltf.primitive()["attributes"]["POSITION"] = accessor;
    EXPECT_EQ(gltf.load().meshes[0].positions, (std::vector<vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    gltf.root["bufferViews"].back()["byteLength"] = 20;
    EXPECT_EQ(gltf.load().meshes[0].positions, (std::vector<vec3>{{1, 2, 3}, {0, 4, 5}, {6, 0, 7}}));
    gltf.root["bufferViews"].back()["byteLength"] = 24;
    gltf.root["bufferViews"].back()["byteStride"] = 8;
    EXPECT_EQ(gltf.load().meshes[0].positions, (std::vector<vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
}

TEST(Gltf, QuantizedPositionsKeepOrNormaliseTheirIntegers) {
    GltfBuilder gltf = one_triangle();
    gltf.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int accessor = gltf.add<std::int16_t>("VEC3", 5122, {0, 0, 0, 32767, -32768, 0, 0, 1, 0});
    gltf.primitive()["attributes"]["POSITION"] = accessor;
    EXPECT_EQ(gltf.load().meshes[0].positions[1], vec3(32767, -32768, 0));
    gltf.root["accessors"][std::size_t(accessor)]["normalized"] = true;
    EXPECT_EQ(gltf.load().meshes[0].positions[1], vec3(1, -1, 0));
    const int bytes = gltf.add<std::uint8_t>("VEC2", 5121, {0, 255, 51, 0, 0, 0});
    gltf.root["accessors"][std::size_t(bytes)]["normalized"] = true;
    gltf.primitive()["attributes"]["TEXCOORD_0"] = bytes;
    EXPECT_EQ(gltf.load().meshes[0].uvs, (std::vector<vec2>{{0, 1}, {0.2f, 0}, {0, 0}}));
}

TEST(Gltf, SparseAccessorsOverwriteTheirBaseOrZeros) {
    GltfBuilder gltf = one_triangle();
    const int indices = gltf.add_view(std::string("\x01\x02", 2));
    const float values[6] = {5, 5, 5, 6, 6, 6};
    const int replaced = gltf.add_view({reinterpret_cast<const char*>(values), sizeof values});
    json& accessor = gltf.root["accessors"][0];
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                          {"values", {{"bufferView", replaced}}}};
    EXPECT_EQ(gltf.load().meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {5, 5, 5}, {6, 6, 6}}));
    accessor.erase("bufferView");
    accessor["sparse"]["count"] = 1;
    EXPECT_EQ(gltf.load().meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {5, 5, 5}, {0, 0, 0}}));
}

TEST(Gltf, MeshesWithoutNormalsHaveNone) { EXPECT_TRUE(one_triangle().load().meshes[0].normals.empty()); }

TEST(Gltf, APrimitiveWithoutNormalsGetsFlatOnesWhereAnotherHasThem) {
    GltfBuilder gltf = one_triangle();
    json other = gltf.primitive();
    other["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {1, 0, 0, 1, 0, 0, 1, 0, 0});
    gltf.root["meshes"][0]["primitives"].push_back(other);
    const Mesh mesh = gltf.load().meshes[0];
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_EQ(mesh.normals[mesh.triangles[0].x], vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[mesh.triangles[1].x], vec3(1, 0, 0));
    EXPECT_EQ(mesh.positions[mesh.triangles[0].y], vec3(1, 0, 0));
}

TEST(Gltf, TangentsStayOnlyWhereTheWholeMeshHasThem) {
    GltfBuilder gltf = one_triangle();
    json& attributes = gltf.primitive()["attributes"];
    attributes["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    attributes["TANGENT"] = gltf.add_floats("VEC4", {1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1});
    EXPECT_EQ(gltf.load().meshes[0].tangents, std::vector<vec4>(3, vec4(1, 0, 0, -1)));
    json other = gltf.primitive();
    other["attributes"].erase("TANGENT");
    gltf.root["meshes"][0]["primitives"].push_back(other);
    EXPECT_TRUE(gltf.load().meshes[0].tangents.empty());
}

TEST(Gltf, NonFiniteVerticesStayAndAreCounted) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["attributes"]["POSITION"] = gltf.add_floats("VEC3", {0, 0, 0, INFINITY, 0, 0, 0, 1, 0});
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.meshes[0].triangles.size(), 1u);
    EXPECT_TRUE(has_warning(scene, "1 of 1 triangles have a NaN or infinite coordinate"));
}

TEST(Gltf, WhatIsIgnoredIsSaidOnce) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["attributes"]["COLOR_1"] = 0;
    gltf.root["meshes"][0]["primitives"].push_back(gltf.primitive());
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.warnings, std::vector<std::string>{"vertex colours other than COLOR_0 are ignored"});
}

TEST(Gltf, TargetsMoveNoColoursAndSayso) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["targets"] = {{{"POSITION", 0}, {"COLOR_0", 0}}, {{"TEXCOORD_0", 0}}};
    EXPECT_EQ(gltf.load().warnings,
              std::vector<std::string>{"colours and texture coordinates of morph targets are ignored"});
}

// 3 or 4 components, float or normalised integers of 8 and 16 bits.
TEST(Gltf, VertexColoursAreTakenAsTheyAre) {
    GltfBuilder gltf = one_triangle();
    const auto colors = [&](int accessor, bool is_normalized) {
        if (is_normalized) gltf.root["accessors"][std::size_t(accessor)]["normalized"] = true;
        gltf.primitive()["attributes"]["COLOR_0"] = accessor;
        const Scene scene = gltf.load();
        EXPECT_TRUE(scene.warnings.empty());
        return scene.meshes[0].colors;
    };
    const std::vector<vec4> opaque = {{0.25f, 0.5f, 0.75f, 1}, {0, 0, 0, 1}, {1, 1, 1, 1}};
    EXPECT_EQ(colors(gltf.add_floats("VEC3", {0.25f, 0.5f, 0.75f, 0, 0, 0, 1, 1, 1}), false), opaque);
    EXPECT_EQ(colors(gltf.add_floats("VEC4", {0.25f, 0.5f, 0.75f, 1, 0, 0, 0, 1, 1, 1, 1, 1}), false), opaque);
    const std::vector<vec4> clear = {{1, 0, 0.2f, 0.2f}, {0, 0.2f, 0, 0}, {1, 1, 1, 1}};
    EXPECT_EQ(colors(gltf.add<std::uint8_t>("VEC4", 5121, {255, 0, 51, 51, 0, 51, 0, 0, 255, 255, 255, 255}), true),
              clear);
    EXPECT_EQ(colors(gltf.add<std::uint16_t>("VEC4", 5123,
                                             {65535, 0, 13107, 13107, 0, 13107, 0, 0, 65535, 65535, 65535, 65535}),
                     true),
              clear);
    EXPECT_EQ(colors(gltf.add_floats("VEC3", {-1, 0.5f, 2, INFINITY, -INFINITY, 1e-40f, 0, 0, 0}), false),
              (std::vector<vec4>{{0, 0.5f, 1, 1}, {1, 0, 1e-40f, 1}, {0, 0, 0, 1}}));
}

TEST(Gltf, ColoursThatAreNoNumbersAreWhiteWithACount) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["attributes"]["COLOR_0"] = gltf.add_floats("VEC3", {NAN, 0.5f, 0, 0, 0, 0, NAN, NAN, NAN});
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.meshes[0].colors, (std::vector<vec4>{{1, 0.5f, 0, 1}, {0, 0, 0, 1}, {1, 1, 1, 1}}));
    EXPECT_TRUE(has_warning(scene, "mesh 0 'tri' primitive 0 COLOR_0: 4 numbers are NaN, and taken as 1"));
}

TEST(Gltf, MeshesWithoutColoursOrSecondTextureCoordinatesHaveNone) {
    const Mesh mesh = one_triangle().load().meshes[0];
    EXPECT_TRUE(mesh.colors.empty());
    EXPECT_TRUE(mesh.second_uvs.empty());
}

// Missing attributes of a primitive: colours are white, and the second texture coordinates are the first.
TEST(Gltf, PrimitivesOfOneMeshMayDifferInTheirAttributes) {
    GltfBuilder gltf = one_triangle();
    json other = gltf.primitive();
    gltf.primitive()["attributes"]["TEXCOORD_0"] = gltf.add_floats("VEC2", {1, 2, 3, 4, 5, 6});
    other["attributes"]["TEXCOORD_1"] = gltf.add_floats("VEC2", {7, 8, 9, 10, 11, 12});
    other["attributes"]["COLOR_0"] = gltf.add_floats("VEC3", {1, 0, 0, 0, 1, 0, 0, 0, 1});
    gltf.root["meshes"][0]["primitives"].push_back(other);
    other["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    for (const bool has_corners_of_its_own : {false, true}) {
        if (has_corners_of_its_own) gltf.root["meshes"][0]["primitives"].push_back(other);
        const Mesh mesh = gltf.load().meshes[0];
        const std::size_t count = has_corners_of_its_own ? 9 : 6;
        ASSERT_EQ(mesh.positions.size(), count);
        ASSERT_EQ(mesh.uvs.size(), count);
        ASSERT_EQ(mesh.second_uvs.size(), count);
        ASSERT_EQ(mesh.colors.size(), count);
        EXPECT_EQ(mesh.uvs[1], vec2(3, 4));
        EXPECT_EQ(mesh.second_uvs[1], vec2(3, 4));
        EXPECT_EQ(mesh.colors[1], vec4(1));
        EXPECT_EQ(mesh.uvs[4], vec2(0));
        EXPECT_EQ(mesh.second_uvs[4], vec2(9, 10));
        EXPECT_EQ(mesh.colors[4], vec4(0, 1, 0, 1));
    }
}

// Colours and second texture coordinates also belong to the vertex: primitives that differ in them share none.
TEST(Gltf, VerticesThatDifferInColourAreNotShared) {
    GltfBuilder gltf = one_triangle();
    json other = gltf.primitive();
    other["attributes"]["COLOR_0"] = gltf.add_floats("VEC3", std::vector<float>(9, 0.5f));
    gltf.root["meshes"][0]["primitives"].push_back(other);
    other["attributes"]["TEXCOORD_1"] = gltf.add_floats("VEC2", std::vector<float>(6, 0.5f));
    gltf.root["meshes"][0]["primitives"].push_back(other);
    EXPECT_EQ(gltf.load().meshes[0].positions.size(), 9u);
}

TEST(Gltf, NormalsWithoutADirectionAreCounted) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 0, NAN, 0, 1, 0, 0, 1e-20f});
    EXPECT_TRUE(has_warning(gltf.load(), "mesh 'tri': 2 of 3 normals are 0, NaN or infinite"));
    gltf.primitive()["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0, -INFINITY, 0, 0, 1e30f, 0, 0, 1});
    EXPECT_TRUE(has_warning(gltf.load(), "mesh 'tri': 1 of 3 normals are 0, NaN or infinite"));
}

TEST(Gltf, FaultsOfSkinsThatNothingUsesDoNotMatter) {
    GltfBuilder gltf = one_triangle();
    gltf.root["skins"] = {{{"joints", "none"}}};
    EXPECT_EQ(count_triangles(gltf.load()), 1u);
}

}  // namespace
}  // namespace twinray::test
