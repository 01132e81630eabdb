// Every fault of a glTF file is one clear Error that names the file, the object and the limit.
#include "tests/scene/gltf_builder.h"

namespace twinray::test {
namespace {

class GltfFault : public testing::TestWithParam<Fault> {};

TEST_P(GltfFault, IsNamed) {
    GltfBuilder gltf = one_triangle();
    GetParam().bend(gltf);
    const std::string message = gltf.error();
    expect_contains(message, "test.gltf");
    expect_contains(message, GetParam().message);
    EXPECT_LT(message.size(), 500u);
}

json& accessor(GltfBuilder& gltf, std::size_t index) { return gltf.root["accessors"][index]; }
json& node(GltfBuilder& gltf, std::size_t index = 0) { return gltf.root["nodes"][index]; }

const Fault accessor_faults[] = {
    {"IndexOutOfRange",
     [](auto& g) {
         g.primitive()["indices"] = g.add_indices({0, 1, 3});
     },
     "mesh 0 'tri' primitive 0: index 3 at position 2 is out of range; POSITION has 3 elements"},
    {"ViewLeavesBuffer", set("/bufferViews/0/byteLength", 1000), "buffer 0 has only 44 bytes"},
    {"ViewOffsetOverflows", set("/bufferViews/0/byteOffset", 0xfffffffffffffff0u), "bufferView 0 takes 36"},
    {"ViewOfNoBuffer", set("/bufferViews/0/buffer", 4), "bufferView 0 names buffer 4; the file has 1"},
    {"AccessorLeavesView", set("/accessors/0/count", 4), "leave bufferView 0, which has 36 bytes"},
    {"AccessorCountOverflows", set("/accessors/0/count", 0x2000000000000001u), "has count"},
    {"AccessorOffsetLeavesView", set("/accessors/0/byteOffset", 40), "leave bufferView 0"},
    {"AccessorOfNoView", set("/accessors/0/bufferView", 9), "bufferView 9 does not exist"},
    {"NoSuchAccessor", set("/meshes/0/primitives/0/attributes/POSITION", 7), "POSITION: accessor 7 does not exist"},
    {"StrideBelowElement", set("/bufferViews/0/byteStride", 4), "byteStride 4 of bufferView 0 is less than"},
    {"PositionsAreNotVec3", set("/accessors/0/type", "VEC2"), "accessor 0 is not of type VEC3"},
    {"PositionsAreDoubles", set("/accessors/0/componentType", 5130), "component type 5130"},
    {"PositionsAreInts", set("/accessors/0/componentType", 5125), "component type 5125"},
    {"IndicesAreFloats", set_floats("/meshes/0/primitives/0/indices", "SCALAR", {0, 1, 2}),
     "component type 5126 is not an unsigned integer"},
    {"UnequalAttributes", set_floats("/meshes/0/primitives/0/attributes/NORMAL", "VEC3", {0, 0, 1}),
     "NORMAL has 1 elements, but POSITION has 3"},
    {"HugeImplicitCount", all_of({without("/accessors/0/bufferView"), set("/accessors/0/count", 4000000000u)}),
     "no bufferView but count 4000000000"},
    {"SparseIndexOutOfRange",
     [](auto& g) {
         const int indices = g.add_view("\x05");
         accessor(g, 0)["sparse"] = {{"count", 1},
                                     {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                     {"values", {{"bufferView", 0}}}};
     },
     "sparse: index 5 at position 0 is not below the count 3"},
    {"SparseCountTooLarge",
     set("/accessors/0/sparse",
         {{"count", 9}, {"indices", {{"bufferView", 0}, {"componentType", 5121}}}, {"values", {{"bufferView", 0}}}}),
     "sparse: count 9"},
    {"SparseIndicesAreFloats",
     set("/accessors/0/sparse",
         {{"count", 1}, {"indices", {{"bufferView", 0}, {"componentType", 5126}}}, {"values", {{"bufferView", 0}}}}),
     "sparse: indices have component type 5126"},
};
INSTANTIATE_TEST_SUITE_P(Accessor, GltfFault, testing::ValuesIn(accessor_faults), fault_name);

const Fault object_faults[] = {
    {"NoSuchMaterial", set("/meshes/0/primitives/0/material", 2), "mesh 0 'tri': material 2 does not exist"},
    {"NoSuchTexture", set("/materials", {{{"name", "m"}, {"normalTexture", {{"index", 3}}}}}),
     "material 0 'm' normalTexture: texture 3 does not exist"},
    {"NoSuchImage",
     all_of({set("/materials", {{{"normalTexture", {{"index", 0}}}}}), set("/textures", {{{"source", 5}}})}),
     "normalTexture: image 5 does not exist"},
    {"NoSuchSampler",
     all_of({set("/materials", {{{"normalTexture", {{"index", 0}}}}}), set("/textures", {{{"sampler", 5}}})}),
     "normalTexture: sampler 5 does not exist"},
    {"NoSuchMesh", set("/nodes/0/mesh", 4), "node 0 'node': mesh 4 does not exist; the file has 1"},
    {"NoSuchCamera", set("/nodes/0/camera", 0), "node 0 'node': camera 0 does not exist"},
    {"NoSuchLight", set("/nodes/0/extensions/KHR_lights_punctual/light", 0), "light 0 does not exist"},
    {"NoSuchScene", set("/scene", 3), "scene 3, the default, does not exist; the file has 1"},
    {"NoSuchChild", set("/nodes/0/children", {8}), "node 0 'node': child 8 does not exist"},
    {"NoSuchSceneNode", set("/scenes/0/nodes", {6}), "the scene lists node 6"},
    {"NodeListedTwice", set("/scenes/0/nodes", {0, 0}), "node 0 'node': is listed twice"},
    {"SceneListsAChild", all_of({set("/nodes/1", {{"children", {0}}}), set("/scenes/0/nodes/1", 1)}),
     "is listed in the scene but is a child of node 1"},
    {"Cycle", all_of({set("/nodes/0/children", {1}), set("/nodes/1", {{"children", {0}}})}),
     "node 0 'node': the node hierarchy has a cycle"},
    {"OwnChild", set("/nodes/0/children", {0}), "node 0 'node': the node hierarchy has a cycle"},
    {"TooDeep",
     [](auto& g) {
         for (int i = 0; i < 1000; ++i) g.append("nodes", i == 999 ? json::object() : json{{"children", {i + 2}}});
         node(g)["children"] = {1};
     },
     "1001 levels deep; the limit is 1000"},
    {"ShortMatrix", set("/nodes/0/matrix", {1, 2, 3}), "matrix has 3 numbers instead of 16"},
    {"ShortTranslation", set("/nodes/0/translation", {1, 2}), "translation has 2 numbers instead of 3"},
    {"ProjectiveMatrix", set("/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
     "matrix: the last row is 1 0 0 1, not 0 0 0 1"},
    {"VisibilityIsNoBool", set("/nodes/0/extensions/KHR_node_visibility/visible", 1),
     "node 0 'node': KHR_node_visibility visible is neither true nor false"},
    {"ColorsAreVec2", set_floats("/meshes/0/primitives/0/attributes/COLOR_0", "VEC2", std::vector<float>(6)),
     "COLOR_0: accessor 2 is not of type VEC3"},
    {"TooFewColors", set_floats("/meshes/0/primitives/0/attributes/COLOR_0", "VEC4", std::vector<float>(8)),
     "COLOR_0 has 2 elements, but POSITION has 3"},
    {"TooFewSecondUvs", set_floats("/meshes/0/primitives/0/attributes/TEXCOORD_1", "VEC2", std::vector<float>(4)),
     "TEXCOORD_1 has 2 elements, but POSITION has 3"},
    {"NoSuchColors", set("/meshes/0/primitives/0/attributes/COLOR_0", 77), "accessor 77 does not exist"},
    {"InfiniteTransform", set("/nodes/0/translation", {1e39, 0, 0}),
     "node 0 'node': its transform to the world has the entry 1e+39"},
    {"ZeroQuaternion", set("/nodes/0/rotation", {0, 0, 0, 0}), "node 0 'node': rotation has length 0"},
    {"UnequalInstancing",
     [](auto& g) {
         const int two = g.add_floats("VEC3", std::vector<float>(6)), one = g.add_floats("VEC3", {1, 1, 1});
         node(g)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", two}, {"SCALE", one}};
     },
     "EXT_mesh_gpu_instancing SCALE has 1 elements, others have 2"},
    {"EmptyScene", set("/scenes/0/nodes", json::array()), "holds no triangles to place"},
    {"OnlyPoints", set("/meshes/0/primitives/0/mode", 0), "holds no triangles to place (mesh 0 'tri': skipped 1"},
};
INSTANTIATE_TEST_SUITE_P(Object, GltfFault, testing::ValuesIn(object_faults), fault_name);

const Fault file_faults[] = {
    {"NoAsset", without("/asset"), "so it is not glTF 2.0"},
    {"VersionOne", set("/asset/version", "1.0"), "is glTF 1.0; only glTF 2.0 is supported"},
#ifndef TWINRAY_HAS_DRACO
    {"DracoRequired", set("/extensionsRequired", {"KHR_draco_mesh_compression"}),
     "needs the glTF extension KHR_draco_mesh_compression, which is not supported; decompress it"},
#endif
    {"UnknownRequired", set("/extensionsRequired", {"ACME_secret"}), "extension ACME_secret"},
#ifndef TWINRAY_HAS_DRACO
    {"DracoWithoutFallback",
     [](auto& g) {
         accessor(g, 0).erase("bufferView");
         g.primitive()["extensions"]["KHR_draco_mesh_compression"] = json::object();
     },
     "needs the glTF extension KHR_draco_mesh_compression"},
#endif
    {"PrimitivesAreNoList", set("/meshes/0/primitives", 3), "JSON /meshes/0/primitives is 3, not a list of objects"},
    {"NodesAreNoList", set("/nodes", "many"), "JSON /nodes is \"many\", not a list of objects"},
    {"ImagesAreNoList", set("/images", 1), "JSON /images is not a list"},
    {"NegativeMesh", set("/nodes/0/mesh", -1), "JSON /nodes/0/mesh is -1, not a non-negative integer"},
    {"ScaleIsNoList", set("/nodes/0/scale", 2), "JSON /nodes/0/scale is 2, not a list of numbers"},
    {"ExtensionIsNoObject", set("/nodes/0/extensions/EXT_mesh_gpu_instancing", 1),
     "JSON /nodes/0/extensions/EXT_mesh_gpu_instancing is not an object"},
    {"UnknownAccessorType", set("/accessors/0/type", "VEC9"), "not valid glTF"},
};
INSTANTIATE_TEST_SUITE_P(File, GltfFault, testing::ValuesIn(file_faults), fault_name);

// These faults are in the bytes around the JSON, where bending it cannot make any.
TEST(GltfFile, DamagedJsonIsNamed) {
    expect_load_error("{\"asset\": ", "a.gltf", "not valid JSON");
    expect_load_error("", "a.gltf", "not valid JSON");
    expect_load_error("[]", "a.gltf", "the JSON is not an object");
    expect_load_error("{\"asset\": {\"version\": \"2.0\"}, \"scene\": 1e999}", "a.gltf", "not valid JSON");
    expect_load_error(std::string(100000, '['), "a.gltf", "nested deeper than 100 levels");
}

TEST(GltfFile, DamagedGlbIsNamed) {
    const std::string glb = one_triangle().as_glb();
    expect_load_error(glb.substr(0, 10), "a.glb", "header is truncated");
    expect_load_error(glb.substr(0, glb.size() - 8), "a.glb", "the GLB is truncated");
    expect_load_error("glTF" + std::string("\x01\0\0\0", 4) + glb.substr(8), "a.glb", "GLB version 1");
    std::string long_chunk = glb;
    long_chunk[14] = '\x7f';
    expect_load_error(long_chunk, "a.glb", "chunk at byte 12");
    std::string no_json = glb;
    no_json[16] = 'X';
    expect_load_error(no_json, "a.glb", "no JSON chunk");
}

TEST(GltfFile, DamagedBuffersAreNamed) {
    GltfBuilder gltf = one_triangle();
    const auto expect_fault = [&](const json& buffer, const std::string& part) {
        gltf.root["buffers"] = json::array({buffer});
        expect_load_error(gltf.root.dump(), "a.gltf", part);
    };
    expect_fault({{"byteLength", 44}, {"uri", "gone.bin"}}, "gone.bin': file not found");
    expect_fault({{"byteLength", 44}, {"uri", "data:;base64,AAAA"}},
                 "buffer 0: byteLength is 44, but its data URI has only 3 bytes");
    expect_fault({{"byteLength", 44}, {"uri", "data:;base64,!"}}, "foreign to base64");
    expect_fault({{"uri", "data:;base64,AAAA"}}, "byteLength is missing");
    expect_fault({{"byteLength", 44}}, "binary chunk has only 0 bytes");
#ifndef TWINRAY_HAS_MESHOPT
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        expect_fault({{"byteLength", 44}, {"extensions", {{name, {{"fallback", true}}}}}}, name);
#endif
}

TEST(GltfFile, AMissingFileIsNamed) {
    expect_error("'no/such/scene.glb': file not found", [] { load_scene("no/such/scene.glb"); });
}

TEST(GltfFile, WhatMovesNoTriangleMayBeRequired) {
    for (const char* name : {"KHR_texture_basisu", "MSFT_texture_dds", "EXT_lights_ies", "EXT_lights_image_based",
                             "KHR_xmp_json_ld", "KHR_physics_rigid_bodies", "KHR_implicit_shapes", "KHR_interactivity",
                             "VRM", "VRMC_vrm", "KHR_animation_pointer", "EXT_structural_metadata", "MSFT_lod"}) {
        GltfBuilder gltf = one_triangle();
        gltf.root["extensionsRequired"] = {name};
        const Scene scene = gltf.load();
        EXPECT_EQ(count_triangles(scene), 1u);
        EXPECT_EQ(scene.warnings, std::vector<std::string>{std::string("shown without the glTF extensions ") + name});
    }
}

TEST(GltfFile, AppearanceExtensionsMayBeRequiredAndAreSkippedWithAWarning) {
    GltfBuilder gltf = one_triangle();
    gltf.root["extensionsRequired"] = {"KHR_materials_iridescence"};
    gltf.root["extensionsUsed"] = {"KHR_materials_iridescence", "KHR_texture_transform"};
    EXPECT_EQ(gltf.load().warnings,
              std::vector<std::string>{"shown without the glTF extensions KHR_materials_iridescence"});
}

}  // namespace
}  // namespace twinray::test
