// SPDX-License-Identifier: MIT
// glTF files whose places float32 cannot hold.
#include "engine/scene/importers/gltf_origin.h"

#include "engine/scene/rig.h"
#include "engine/scene/glb.h"
#include "tests/scene/far_houses.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

TEST(FarGltf, NodesAreComposedInFloat64) {
    GltfBuilder gltf = far_houses_gltf();
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.origin, dvec3(500'010, 5'400'010, 0));
    EXPECT_EQ(scene.meshes.size(), 1u);
    expect_far_houses(scene, rounding);
    // All below a node that has moved them there.
    json roots = gltf.root["scenes"][0]["nodes"];
    for (json& node : gltf.root["nodes"])
        for (int axis = 0; axis < 3; ++axis)
            node["translation"][std::size_t(axis)] =
                node["translation"][std::size_t(axis)].get<double>() - far_away[axis];
    gltf.root["scenes"][0]["nodes"] = json::array();
    gltf.add_node({{"children", roots}, {"translation", {far_away.x, far_away.y, far_away.z}}});
    EXPECT_EQ(gltf.load().origin, scene.origin);
    expect_far_houses(gltf.load(), rounding);
}

TEST(FarGltf, InstancingIsMovedAlong) {
    GltfBuilder gltf = far_houses_gltf();
    const House first = far_houses()[0];
    std::vector<float> offsets;
    for (const House& house : far_houses())
        for (int axis = 0; axis < 3; ++axis) offsets.push_back(static_cast<float>((house.lo - first.lo)[axis]));
    gltf.root["scenes"][0]["nodes"] = {0};
    gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        gltf.add_floats("VEC3", offsets);
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.instances.size(), 4u);
    EXPECT_EQ(scene.origin, dvec3(500'010, 5'400'010, 0));
    expect_far_houses(scene, rounding);
}

// A triangle whose vertices are themselves large, in halves of a metre, which is what float32 has there.
GltfBuilder large_vertices() {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["attributes"]["POSITION"] =
        gltf.add_floats("VEC3", {500'001.5f, 5'400'000.5f, 1, 500'010.25f, 5'400'000, 2, 500'000, 5'400'009, 3});
    return gltf;
}

TEST(FarGltf, LargeVerticesAreMovedSinceRaysAreRoundedInTheSpaceOfTheMesh) {
    const Scene scene = large_vertices().load();
    EXPECT_EQ(scene.origin, dvec3(500'010, 5.4e6, 0));
    EXPECT_EQ(scene.instances[0].transform, Transform());
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{-8.5f, 0.5f, 1}, {0.25f, 0, 2}, {-10, 9, 3}}));
    // A node that brings them back, once with a turn.
    GltfBuilder back = large_vertices();
    back.root["nodes"][0]["translation"] = {-500'000, -5.4e6, 0};
    const Scene there_and_back = back.load();
    EXPECT_EQ(there_and_back.origin, dvec3(0));
    EXPECT_EQ(there_and_back.instances[0].transform, Transform());
    EXPECT_EQ(there_and_back.meshes[0].positions, (std::vector<vec3>{{1.5f, 0.5f, 1}, {10.25f, 0, 2}, {0, 9, 3}}));
    back.root["nodes"][0]["rotation"] = {0, 0, 1, 0};
    back.root["nodes"][0]["translation"] = {500'000, 5.4e6, 0};
    const Scene turned = back.load();
    EXPECT_EQ(turned.instances[0].transform, Transform::scaling({-1, -1, 1}));
    EXPECT_EQ(turned.meshes[0].positions, there_and_back.meshes[0].positions);
}

TEST(FarGltf, NothingIsMovedWhereTheFilesCoordinatesAreWanted) {
    GltfBuilder back = large_vertices();
    back.root["nodes"][0]["translation"] = {-500'000, -5.4e6, 0};
    const TempDir folder;
    const Scene scene = load_scene(folder.write("a.gltf", back.with_data_uri()), dvec3(0));
    EXPECT_EQ(scene.meshes[0].positions[0], vec3(500'001.5f, 5'400'000.5f, 1));
    EXPECT_EQ(scene.instances[0].transform, Transform::translation({-500'000, -5.4e6f, 0}));
}

TEST(FarGltf, CamerasAndLightsAreMovedAlong) {
    GltfBuilder gltf = far_houses_gltf();
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    gltf.add_node({{"camera", 0}, {"translation", {500'001.25, 5'400'002.5, 7.75}}, {"scale", {2, 2, 2}}});
    gltf.add_node(
        {{"translation", {500'003.25, 5'400'001.5, 9}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.origin, dvec3(500'010, 5'400'010, 0));
    EXPECT_EQ(scene.cameras[0].camera_to_world, Transform::translation({-8.75f, -7.5f, 7.75f}));
    EXPECT_EQ(scene.lights[0].position, vec3(-6.75f, -8.5f, 9));
}

// Node 0 goes 1.5 m east within a second, told by key frames in the file's coordinates.
GltfBuilder moving_triangle() {
    GltfBuilder gltf = one_triangle();
    gltf.root["nodes"][0]["translation"] = {far_away.x + 0.5, far_away.y, far_away.z};
    const int times = gltf.add_floats("SCALAR", {0, 1});
    const int places = gltf.add_floats("VEC3", {500'000.5f, 5.4e6f, 0, 500'002, 5.4e6f, 0});
    gltf.root["animations"] = {{{"samplers", {{{"input", times}, {"output", places}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    return gltf;
}

TEST(FarGltf, PosesOfAnAnimationAreRelativeToTheOrigin) {
    GltfBuilder gltf = moving_triangle();
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    gltf.root["nodes"][0]["camera"] = 0;
    Scene scene = gltf.load();
    EXPECT_EQ(scene.origin, dvec3(500'001, 5'400'001, 0));
    EXPECT_EQ(scene.rig->origin, scene.origin);
    EXPECT_EQ(scene.instances[0].transform, Transform::translation({-0.5f, -1, 0}));
    pose_scene(scene, pose_at(*scene.rig, scene.rig->animations[0], 0.3));
    EXPECT_NEAR(scene.instances[0].transform.rows[0].w, -0.05, 1e-6);
    EXPECT_NEAR(scene.cameras[0].camera_to_world.rows[0].w, -0.05, 1e-6);
    pose_scene(scene, rest_pose(*scene.rig));
    EXPECT_EQ(scene.instances[0].transform, Transform::translation({-0.5f, -1, 0}));
}

TEST(FarGltf, AnimatedLargeVerticesTurnAboutTheirNode) {
    GltfBuilder gltf = large_vertices();
    const int times = gltf.add_floats("SCALAR", {0, 1});
    const int turns = gltf.add_floats("VEC4", {0, 0, 0, 1, 0, 0, 1, 0});
    gltf.root["animations"] = {{{"samplers", {{{"input", times}, {"output", turns}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}};
    Scene scene = gltf.load();
    pose_scene(scene, pose_at(*scene.rig, scene.rig->animations[0], 1));  // half a turn about 0, so far away
    const dvec3 corner =
        scene.origin + dvec3(transform_point(scene.instances[0].transform, scene.meshes[0].positions[1]));
    EXPECT_NEAR(corner.x, -500'010.25, 0.5);
    EXPECT_NEAR(corner.y, -5'400'000, 0.5);
}

// A triangle that follows one joint, bound where it is; `bind` and `place`: of the joint.
GltfBuilder skinned_triangle(const GltfBuilder& base, const dvec3& bind, const dvec3& place) {
    GltfBuilder gltf = base;
    json& attributes = gltf.primitive()["attributes"];
    attributes["JOINTS_0"] = gltf.add<std::uint8_t>("VEC4", 5121, std::vector<std::uint8_t>(12, 0));
    attributes["WEIGHTS_0"] = gltf.add_floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    std::vector<float> matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (int axis = 0; axis < 3; ++axis) matrix[std::size_t(12 + axis)] = -static_cast<float>(bind[axis]);
    gltf.root["skins"] = {{{"joints", {1}}, {"inverseBindMatrices", gltf.add_floats("MAT4", matrix)}}};
    gltf.root["nodes"][0]["skin"] = 0;
    gltf.add_node({{"translation", {place.x, place.y, place.z}}});
    return gltf;
}

TEST(FarGltf, SkinsFollowTheirJoints) {
    const Scene scene = skinned_triangle(one_triangle(), dvec3(0), far_away + dvec3(0.13, 0.27, 0)).load();
    EXPECT_EQ(scene.origin, dvec3(500'001, 5'400'001, 0));
    EXPECT_EQ(scene.instances[0].transform, Transform());
    EXPECT_NEAR(scene.meshes[0].positions[0].x, -0.87, 1e-7);
    EXPECT_NEAR(scene.meshes[0].positions[2].y, 0.27, 1e-7);
}

TEST(FarGltf, SkinsThatWereBoundFarAwayAreMovedAtTheirBind) {
    const Scene scene = skinned_triangle(large_vertices(), far_away, far_away + dvec3(0.13, 0, 0)).load();
    EXPECT_EQ(scene.origin, dvec3(500'010, 5'400'000, 0));
    EXPECT_NEAR(scene.meshes[0].positions[0].x, -8.37, 1e-6);
    EXPECT_NEAR(scene.meshes[0].positions[0].y, 0.5, 1e-6);
    GltfBuilder turning = skinned_triangle(large_vertices(), far_away, far_away);
    const int times = turning.add_floats("SCALAR", {0, 1});
    const int turns = turning.add_floats("VEC4", {0, 0, 0, 1, 0, 0, 1, 0});
    turning.root["animations"] = {{{"samplers", {{{"input", times}, {"output", turns}}}},
                                   {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}}};
    const Scene moving = turning.load();
    const Rig& rig = *moving.rig;
    const MeshVertices turned = deformed(rig, rig.meshes[0], pose_at(rig, rig.animations[0], 1));
    EXPECT_NEAR(moving.origin.x + double(turned.positions[1].x), 499'989.75, 1e-5);
    EXPECT_NEAR(moving.origin.y + double(turned.positions[1].y), 5'400'000, 1e-5);
}

TEST(FarGltf, WhatNoNodePlacesIsPlacedInTheFile) {
    GltfBuilder gltf = skinned_triangle(one_triangle(), dvec3(0), dvec3(0, 1, 0));
    gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] =
        gltf.add_floats("VEC3", {2, 2, 2});
    const TempDir folder;
    const Scene scene = load_scene(folder.write("a.gltf", gltf.with_data_uri()), dvec3(5, 0, 0));
    const vec3 corner = transform_point(scene.instances[0].transform, scene.meshes[0].positions[1]);
    EXPECT_EQ(scene.origin + dvec3(corner), dvec3(2, 2, 0));  // twice (1, 1, 0)
}

TEST(FarGltf, MorphTargetsOfLargeVerticesAreMovedWithThem) {
    GltfBuilder gltf = large_vertices();
    gltf.primitive()["targets"] = {{{"POSITION", gltf.add_floats("VEC3", {0, 0, 4, 0, 0, 0, 0, 0, 0})}}};
    gltf.root["meshes"][0]["weights"] = {0.5};
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.meshes[0].positions[0], vec3(-8.5f, 0.5f, 3));
    EXPECT_EQ(scene.instances[0].transform, Transform());
}

TEST(FarGltf, AnOriginMayBeChosen) {
    GltfBuilder gltf = one_triangle();
    const TempDir folder;
    const auto file = folder.write("a.gltf", gltf.with_data_uri());
    EXPECT_EQ(load_scene(file).origin, dvec3(0));
    const Scene moved = load_scene(file, dvec3(5, 0, 0));
    EXPECT_EQ(moved.origin, dvec3(5, 0, 0));
    EXPECT_EQ(moved.instances[0].transform, Transform::translation({-5, 0, 0}));
    EXPECT_EQ(moved.meshes[0].positions, load_scene(file).meshes[0].positions);
}

TEST(FarGlb, KeepsItsPlace) {
    const TempDir folder;
    const Scene scene = far_houses_gltf().load();
    write_glb(folder / "a.glb", scene, std::vector<Rgb>(count_triangles(scene)));
    const Scene again = load_scene(folder / "a.glb");
    EXPECT_EQ(again.origin, scene.origin);
    ASSERT_EQ(again.instances.size(), scene.instances.size());
    for (std::size_t i = 0; i < again.instances.size(); ++i)
        EXPECT_EQ(again.instances[i].transform, scene.instances[i].transform);
}

}  // namespace
}  // namespace twinray::test
