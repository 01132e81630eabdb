// Animations, skins, morph targets and material variants of glTF files, and their faults.
#include "engine/scene/rig.h"
#include "tests/scene/gltf_builder.h"

namespace twinray::test {
namespace {

json& animation(GltfBuilder& gltf) { return gltf.root["animations"][0]; }

// Puts the triangle of one_triangle() on two joints. The second, at (0, 1, 0), carries the vertex (0, 1, 0) and turns
// by 90 degrees about x within a second. Nodes: 0 the mesh, moved aside in vain, 1 and 2 the joints.
GltfBuilder skinned_triangle() {
    GltfBuilder gltf = one_triangle();
    json& attributes = gltf.primitive()["attributes"];
    attributes["JOINTS_0"] = gltf.add<std::uint8_t>("VEC4", 5121, {0, 9, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
    const int weights = gltf.add<std::uint8_t>("VEC4", 5121, {255, 0, 0, 0, 51, 0, 0, 0, 255, 0, 0, 0});
    gltf.root["accessors"][std::size_t(weights)]["normalized"] = true;
    attributes["WEIGHTS_0"] = weights;
    const int inverse_binds = gltf.add_floats(
        "MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1});
    gltf.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse_binds}}};
    gltf.root["nodes"][0]["skin"] = 0;
    gltf.root["nodes"][0]["translation"] = {100, 0, 0};
    gltf.add_node({{"name", "hip"}, {"translation", {5, 0, 0}}, {"children", {2}}});
    gltf.append("nodes", {{"name", "knee"}, {"translation", {0, 1, 0}}});
    gltf.animate(2, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, 0.70710678f, 0, 0, 0.70710678f});
    animation(gltf)["name"] = "kick";
    return gltf;
}

void expect_near(vec3 found, vec3 expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1e-6);
}

TEST(GltfSkin, AMeshWhoseSkinIsBrokenIsLeftOut) {
    GltfBuilder gltf = skinned_triangle();
    gltf.root["skins"][0]["joints"] = {1, gltf.append("nodes", json::object())};
    gltf.add_node({{"name", "whole"}, {"mesh", 0}});
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].name, "whole");
    EXPECT_TRUE(has_warning(scene,
                            "skin 0: joint 3 is a node that is not in the shown scene; the mesh of node 0 'node' "
                            "is not shown"));
}

TEST(GltfSkin, APrimitiveWithoutJointsFollowsTheFirst) {
    GltfBuilder gltf = skinned_triangle();
    json rigid = gltf.primitive();
    rigid["attributes"].erase("JOINTS_0"), rigid["attributes"].erase("WEIGHTS_0");
    gltf.root["meshes"][0]["primitives"].push_back(rigid);
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.meshes[0].positions.size(), 6u);
    EXPECT_EQ(scene.meshes[0].positions[3], scene.meshes[0].positions[0]);
    EXPECT_TRUE(has_warning(scene, "3 vertices have no weights and follow the skin's first joint"));
}

TEST(GltfSkin, TheRestPoseIsShownWhereTheJointsAreNotWhereTheNodeIs) {
    GltfBuilder gltf = skinned_triangle();
    const Scene scene = gltf.load();
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.instances[0].transform, Transform());
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{5, 0, 0}, {6, 0, 0}, {5, 1, 0}}));
    ASSERT_TRUE(scene.rig);
    gltf.root.erase("animations");
    EXPECT_FALSE(gltf.load().rig);
    EXPECT_EQ(gltf.load().meshes[0].positions, scene.meshes[0].positions);
}

TEST(GltfSkin, VerticesFollowTheirJoints) {
    GltfBuilder gltf = skinned_triangle();
    // A second set: half of vertex 1 follows the knee.
    gltf.primitive()["attributes"]["JOINTS_1"] =
        gltf.add<std::uint16_t>("VEC4", 5123, {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0});
    gltf.primitive()["attributes"]["WEIGHTS_1"] = gltf.add_floats("VEC4", {0, 0, 0, 0, 0, 0.2f, 0, 0, 0, 0, 0, 0});
    const Scene scene = gltf.load();
    const Rig& rig = *scene.rig;
    ASSERT_EQ(rig.meshes.size(), 1u);
    EXPECT_EQ(rig.meshes[0].motion.influences, 8u);
    const MeshVertices kicked = deformed(rig, rig.meshes[0], pose_at(rig, rig.animations[0], 1));
    expect_near(kicked.positions[0], {5, 0, 0});
    expect_near(kicked.positions[1], {6, 0.5f, -0.5f});  // half (6, 0, 0), half (6, 1, -1)
    expect_near(kicked.positions[2], {5, 1, 0});
}

TEST(GltfSkin, WeightsAreNormalisedAndCornersWithoutAnyFollowTheFirstJoint) {
    GltfBuilder gltf = skinned_triangle();
    gltf.primitive()["attributes"]["WEIGHTS_0"] = gltf.add_floats("VEC4", {3, 0, 0, 0, 1, 0, 3, 0, 0, 0, 0, 0});
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.rig->meshes[0].motion.weights, (std::vector<float>{1, 0, 0, 0, 0.25f, 0, 0.75f, 0, 1, 0, 0, 0}));
    EXPECT_TRUE(has_warning(scene, "1 vertices have no weights and follow the skin's first joint"));
}

TEST(GltfSkin, TheLastRowOfAnInverseBindMatrixMayBeRounded) {
    GltfBuilder gltf = skinned_triangle();
    const std::vector<vec3> exact = gltf.load().meshes[0].positions;
    gltf.root["skins"][0]["inverseBindMatrices"] =
        gltf.add_floats("MAT4", {1, 0, 0, 1e-17f, 0, 1, 0, -2e-9f, 0, 0, 1, 1e-12f, 0, 0,  0, 1,
                                 1, 0, 0, 0,      0, 1, 0, 0,      0, 0, 1, 0,      0, -1, 0, 0.9999999f});
    const std::vector<vec3> found = gltf.load().meshes[0].positions;
    for (std::size_t i = 0; i < 3; ++i) expect_near(found[i], exact[i]);
}

TEST(GltfMorph, NodesShowTheirWeightsAndShareAMeshWhereTheyAreEqual) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["targets"] = {{{"POSITION", gltf.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 0, 4})}},
                                   {{"POSITION", gltf.add_floats("VEC3", {0, 0, 8, 0, 0, 0, 0, 0, 0})}}};
    gltf.root["meshes"][0]["weights"] = {0.5, 0};
    gltf.add_node({{"mesh", 0}, {"weights", {0, 1}}});
    gltf.add_node({{"mesh", 0}});
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1.5f, 0, 0}, {0, 1, 2}}));
    EXPECT_EQ(scene.meshes[1].positions, (std::vector<vec3>{{0, 0, 8}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.instances[0].mesh + scene.instances[1].mesh, 0u);
    EXPECT_FALSE(scene.rig);
}

TEST(GltfMorph, DrivenWeightsMoveOneNodeAlone) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["targets"] = {{{"POSITION", gltf.add_floats("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 4})}}};
    gltf.add_node({{"mesh", 0}});
    gltf.animate(1, "weights", {0, 2}, "SCALAR", {0, 1});
    const Scene scene = gltf.load();
    const Rig& rig = *scene.rig;
    ASSERT_EQ(rig.meshes.size(), 2u);
    const Pose pose = pose_at(rig, rig.animations[0], 1);
    EXPECT_EQ(deformed(rig, rig.meshes[0], pose).positions[2], vec3(0, 1, 0));
    EXPECT_EQ(deformed(rig, rig.meshes[1], pose).positions[2], vec3(0, 1, 2));
}

TEST(GltfAnimation, InstancesCamerasAndLightsMoveWithTheirNodes) {
    GltfBuilder gltf = skinned_triangle();
    gltf.append("meshes", gltf.root["meshes"][0]);
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}};
    const int offset = gltf.add_floats("VEC3", {0, 2, 0});
    gltf.root["nodes"][2]["mesh"] = 1;
    gltf.root["nodes"][2]["camera"] = 0;
    gltf.root["nodes"][2]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}},
                                           {"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", offset}}}}}};
    Scene scene = gltf.load();
    pose_scene(scene, pose_at(*scene.rig, scene.rig->animations[0], 1));
    EXPECT_EQ(scene.instances[0].transform, Transform());
    expect_near(transform_point(scene.instances[1].transform, vec3(0)), {5, 1, 2});
    expect_near(transform_point(scene.cameras[0].camera_to_world, vec3(0, 0, -1)), {5, 2, 0});
    expect_near(scene.lights[0].position, {5, 1, 0});
    expect_near(scene.lights[0].direction, {0, 1, 0});
}

// Makes the triangle, and a box of it on a node without size at rest; an animation drives its scale or its parent's.
GltfBuilder growing_triangle(int driven) {
    GltfBuilder gltf = one_triangle();
    gltf.add_node({{"name", "pot"}, {"translation", {3, 0, 0}}, {"children", {2}}});
    gltf.append("nodes", {{"name", "plant"}, {"mesh", 0}});
    gltf.root["nodes"][std::size_t(driven)]["scale"] = {0, 0, 0};
    gltf.animate(driven, "scale", {0, 1}, "VEC3", {0, 0, 0, 2, 2, 2});
    return gltf;
}

TEST(GltfAnimation, WhatGrowsFromNothingIsHiddenAtRest) {
    for (const int driven : {1, 2}) {
        SCOPED_TRACE(driven);
        Scene scene = growing_triangle(driven).load();
        EXPECT_TRUE(scene.warnings.empty());
        ASSERT_EQ(scene.instances.size(), 1u);
        EXPECT_EQ(scene.instances[0].name, "node");
        ASSERT_EQ(scene.rig->hidden.size(), 1u);
        const Rig& as_loaded = *scene.rig;
        const auto keep = scene.rig;
        show_hidden(scene);
        EXPECT_EQ(as_loaded.hidden.size(), 1u);  // others may hold it
        EXPECT_TRUE(scene.rig->hidden.empty());
        ASSERT_EQ(scene.instances.size(), 2u);
        EXPECT_EQ(scene.instances[1].name, "plant");
        pose_scene(scene, rest_pose(*scene.rig));
        EXPECT_EQ(determinant(scene.instances[1].transform), 0);
        pose_scene(scene, pose_at(*scene.rig, scene.rig->animations[0], 0.5));
        EXPECT_EQ(scene.instances[0].transform, Transform());
        EXPECT_EQ(scene.instances[1].transform, Transform::translation({3, 0, 0}));
    }
}

// With several meshes, instances stay grouped by mesh.
TEST(GltfAnimation, HiddenInstancesTakeTheirPlaceAmongThoseOfTheirMesh) {
    GltfBuilder gltf = growing_triangle(2);
    gltf.append("meshes", gltf.root["meshes"][0]);
    gltf.add_node({{"name", "last"}, {"mesh", 1}});
    Scene scene = gltf.load();
    show_hidden(scene);
    ASSERT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(scene.instances[1].name, "plant");
    EXPECT_EQ(scene.instances[2].name, "last");
    pose_scene(scene, pose_at(*scene.rig, scene.rig->animations[0], 1));
    EXPECT_EQ(scene.instances[1].transform.rows[0], vec4(2, 0, 0, 3));
    EXPECT_EQ(scene.instances[2].transform, Transform());
}

TEST(GltfAnimation, WhatNothingScalesIsSkipped) {
    GltfBuilder gltf = growing_triangle(2);
    animation(gltf)["channels"][0]["target"]["node"] = 0;
    const Scene scene = gltf.load();
    EXPECT_TRUE(has_warning(scene, "node 2 'plant': skipped 1 of 1 placements"));
    EXPECT_TRUE(scene.rig->hidden.empty());
}

// Stop-motion has this: each frame is a node that is shown for a moment.
TEST(GltfAnimation, AllMayBeHiddenAtRest) {
    GltfBuilder gltf = growing_triangle(1);
    gltf.root["nodes"][0].erase("mesh");
    Scene scene = gltf.load();
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(has_warning(scene, "at rest nothing is shown"));
    show_hidden(scene);
    EXPECT_EQ(scene.instances.size(), 1u);
}

TEST(GltfAnimation, VisibilityThatAnAnimationDrivesStaysWithAWarning) {
    GltfBuilder gltf = skinned_triangle();
    const json pointer = {{"pointer", "/nodes/0/extensions/KHR_node_visibility/visible"}};
    animation(gltf)["channels"].push_back(
        {{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", pointer}}}}}});
    const Scene scene = gltf.load();
    EXPECT_TRUE(has_warning(scene, "animation 0 'kick': shows and hides nodes, which stay as they are at rest"));
    EXPECT_EQ(scene.rig->animations[0].fault, "");
}

TEST(GltfVariants, MaterialsAreThoseOfTheirMappings) {
    GltfBuilder gltf = one_triangle();
    gltf.root["materials"] = {{{"name", "red"}}, {{"name", "green"}}};
    gltf.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "summer"}}, {{"name", "winter"}}};
    gltf.root["meshes"][0]["primitives"].push_back(gltf.primitive());
    gltf.primitive(0)["material"] = 0;
    gltf.primitive(1)["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {1}}}};
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.variants.size(), 2u);
    EXPECT_EQ(scene.variants[1].name, "winter");
    EXPECT_EQ(scene.meshes[0].materials, (std::vector<uint>{0, 2}));
    EXPECT_EQ(scene.variants[0].parts[0].materials, (std::vector<uint>{0, 2}));
    EXPECT_EQ(scene.variants[1].parts[0].materials, (std::vector<uint>{0, 1}));
}

// A fault in the rest pose is an error.
class GltfShapeFault : public testing::TestWithParam<Fault> {};
TEST_P(GltfShapeFault, IsNamed) {
    GltfBuilder gltf = skinned_triangle();
    GetParam().bend(gltf);
    expect_contains(gltf.error(), "test.gltf");
    expect_contains(gltf.error(), GetParam().message);
}

json& skin(GltfBuilder& gltf) { return gltf.root["skins"][0]; }
json& attribute(GltfBuilder& gltf, const char* name) { return gltf.primitive()["attributes"][name]; }

const Fault shape_faults[] = {
    {"NoSuchSkin", set("/nodes/0/skin", 3), "node 0 'node': skin 3 does not exist"},
    {"SkinIsNoIndex", set("/nodes/0/skin", "fur"), "JSON /nodes/0/skin is \"fur\""},
    {"NoJoints", set("/skins/0/joints", "none"), "skin 0: has no list of joints"},
    {"NoSuchJoint", set("/skins/0/joints", {1, 7}), "skin 0: joint 7 does not exist; the file has 3 nodes"},
    {"JointIsNotShown",
     [](auto& g) {
         skin(g)["joints"] = {1, g.append("nodes", json::object())};
     },
     "joint 3 is a node that is not in the shown scene"},
    {"FewInverseBinds", set_floats("/skins/0/inverseBindMatrices", "MAT4", std::vector<float>(16)),
     "inverseBindMatrices has 1 matrices, but there are 2 joints"},
    {"InverseBindIsNaN", set_floats("/skins/0/inverseBindMatrices", "MAT4", std::vector<float>(32, NAN)),
     "inverseBindMatrices 0 has the entry nan"},
    {"InverseBindProjects", set_floats("/skins/0/inverseBindMatrices", "MAT4", std::vector<float>(32, 1)),
     "inverseBindMatrices 0: the last row is 1 1 1 1, not 0 0 0 1"},
    {"NegativeWeight",
     set_floats("/meshes/0/primitives/0/attributes/WEIGHTS_0", "VEC4", {1, 0, 0, 0, -1, 2, 0, 0, 1, 0, 0, 0}),
     "WEIGHTS_0 of vertex 1 is -1"},
    {"TooFewWeights", set_floats("/meshes/0/primitives/0/attributes/WEIGHTS_0", "VEC4", {1, 0, 0, 0}),
     "WEIGHTS_0 has 1 elements, but POSITION has 3"},
    {"JointBeyondTheSkin",
     [](auto& g) {
         attribute(g, "JOINTS_0") = g.template add<std::uint8_t>("VEC4", 5121, {0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0});
     },
     "mesh 0 'tri': vertex 1 follows joint 2, but its skin has 2"},
    {"JointIsNoInteger", set_floats("/meshes/0/primitives/0/attributes/JOINTS_0", "VEC4", std::vector<float>(12, 0.5f)),
     "JOINTS_0 of vertex 0 is 0.5"},
    {"TooManyMorphWeights", set("/nodes/0/weights", {1, 2}), "there are 2 morph weights, but its mesh has 0 targets"},
    {"UnequalTargets",
     [](auto& g) {
         g.root["meshes"][0]["primitives"].push_back(g.primitive());
         g.primitive(1)["targets"] = {{{"POSITION", 0}}};
     },
     "one primitive has 0 morph targets, another 1"},
    {"ShortTarget",
     [](auto& g) {
         g.primitive()["targets"] = {{{"POSITION", g.add_floats("VEC3", {0, 0, 0})}}};
     },
     "target 0: POSITION has 1 elements, but POSITION has 3"},
    {"NoSuchVariant",
     all_of({set("/materials", json::array({json::object()})),
             set("/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings",
                 {{{"material", 0}, {"variants", {4}}}})}),
     "KHR_materials_variants names variant 4; the file has 0"},
};
INSTANTIATE_TEST_SUITE_P(All, GltfShapeFault, testing::ValuesIn(shape_faults), fault_name);

// An animation with a fault cannot be played; nothing else changes.
class GltfAnimationFault : public testing::TestWithParam<Fault> {};
TEST_P(GltfAnimationFault, IsWarnedOf) {
    GltfBuilder gltf = skinned_triangle();
    gltf.root["animations"].push_back(animation(gltf));
    GetParam().bend(gltf);
    const Scene scene = gltf.load();
    EXPECT_TRUE(has_warning(scene, "animation 0"));
    expect_contains(scene.rig->animations[0].fault, GetParam().message);
    EXPECT_TRUE(scene.rig->animations[0].channels.empty());
    EXPECT_EQ(scene.rig->animations[1].fault, "");
    EXPECT_EQ(scene.rig->animations[1].channels.size(), 1u);
}

json& channel(GltfBuilder& gltf) { return animation(gltf)["channels"][0]; }

const Fault animation_faults[] = {
    {"IsNoObject", set("/animations/0", 4), "is not an object"},
    {"SamplersAreNoList", set("/animations/0/samplers", 5), "samplers is not a list"},
    {"ChannelWithoutTarget", without("/animations/0/channels/0/target"), "channel 0: has no target"},
    {"NoSuchNode", set("/animations/0/channels/0/target/node", 9), "channel 0: node 9 does not exist"},
    {"NoSuchSampler", set("/animations/0/channels/0/sampler", 1), "its sampler does not exist; there are 1"},
    {"NoSuchPath", set("/animations/0/channels/0/target/path", "colour"), "path is neither"},
    {"NoSuchInterpolation", set("/animations/0/samplers/0/interpolation", "BEZIER"), "interpolation is neither"},
    {"NoInput", without("/animations/0/samplers/0/input"), "sampler 0: input is missing"},
    {"NoSuchAccessor", set("/animations/0/samplers/0/output", 99), "sampler 0 output: accessor 99 does not exist"},
    {"TimesGoBack", set_floats("/animations/0/samplers/0/input", "SCALAR", {1, 0}),
     "time 1 is 0, before the one before it, 1"},
    {"TimeIsNaN", set_floats("/animations/0/samplers/0/input", "SCALAR", {0, NAN}), "time 1 is nan"},
    {"NoTimes", set_floats("/animations/0/samplers/0/input", "SCALAR", {}), "has no times"},
    {"TooFewValues", set("/animations/0/samplers/0/interpolation", "CUBICSPLINE"),
     "output has 8 numbers, but 2 times need 24"},
    {"ValueIsInfinite", set_floats("/animations/0/samplers/0/output", "VEC4", {0, 0, 0, 1, 0, INFINITY, 0, 1}),
     "output has the number inf at time 1"},
    {"RotationWithoutLength", set_floats("/animations/0/samplers/0/output", "VEC4", {0, 0, 0, 1, 0, 0, 0, 0}),
     "the rotation at time 1 has length 0"},
    {"DrivenTwice", [](auto& g) { animation(g)["channels"].push_back(channel(g)); },
     "channel 1: drives the same property as another"},
    {"WeightsOfNoTargets", set("/animations/0/channels/0/target/path", "weights"), "without morph targets"},
    {"DrivesAMatrix",
     all_of({set("/animations/1/channels/0/target/node", 0),
             set("/nodes/2", {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}})}),
     "drives a node that has a matrix"},
};
INSTANTIATE_TEST_SUITE_P(All, GltfAnimationFault, testing::ValuesIn(animation_faults), fault_name);

TEST(GltfAnimation, ChannelsOfNoShownNodeAreOfNoEffect) {
    GltfBuilder gltf = skinned_triangle();
    const int hidden = gltf.append("nodes", json::object());
    channel(gltf)["target"]["node"] = hidden;
    animation(gltf)["channels"].push_back({{"sampler", 0}, {"target", {{"path", "pointer"}}}});
    const Scene scene = gltf.load();
    EXPECT_TRUE(scene.rig->animations[0].channels.empty());
    EXPECT_EQ(scene.rig->animations[0].fault, "");
}

}  // namespace
}  // namespace twinray::test
