// Files with coordinates that float32 cannot hold: the origins that are chosen for them, and .ply and glTF files.
#include "engine/scene/local_origin.h"

#include "engine/scene/glb.h"
#include "engine/scene/rig.h"
#include "tests/scene/far_houses.h"

namespace twinray::test {
namespace {

Bounds64 box(const dvec3& lo, const dvec3& hi) {
    Bounds64 bounds;
    bounds.include(lo), bounds.include(hi);
    return bounds;
}

TEST(LocalOrigin, OrdinaryPlacesAreLeftAlone) {
    EXPECT_EQ(choose_local_origin({}), dvec3(0));
    EXPECT_EQ(choose_local_origin(box(dvec3(0), dvec3(0))), dvec3(0));
    EXPECT_EQ(choose_local_origin(box(dvec3(-3), dvec3(5))), dvec3(0));
    EXPECT_EQ(choose_local_origin(box(dvec3(15, 0, 0), dvec3(16, 0.1, 0))), dvec3(0));        // 16 extents away
    EXPECT_EQ(choose_local_origin(box(dvec3(0, 5e6, 0), dvec3(400e3, 5.4e6, 0))), dvec3(0));  // a whole country
    EXPECT_EQ(choose_local_origin(box(dvec3(1e-40), dvec3(1.00001e-40))), dvec3(0));          // float32 has no more
    EXPECT_EQ(choose_local_origin(box(dvec3(-1e308), dvec3(1e308))), dvec3(0));
}

TEST(LocalOrigin, FarPlacesGetARoundNumberNearTheirMiddle) {
    EXPECT_EQ(choose_local_origin(box(dvec3(15.1, 0, 0), dvec3(16.1, 0.1, 0))), dvec3(16, 0, 0));
    EXPECT_EQ(choose_local_origin(box(dvec3(500e3, 5.4e6, 0), dvec3(500'010, 5'400'009, 3))), dvec3(500'010, 5.4e6, 0));
    EXPECT_EQ(choose_local_origin(box(dvec3(490e3, 5.4e6, 400), dvec3(510e3, 5'412'300, 812))),
              dvec3(500e3, 5'410'000, 0));
    EXPECT_EQ(choose_local_origin(box(dvec3(-2'000'000.37), dvec3(-2'000'000.31))), dvec3(-2'000'000.34375));
    EXPECT_EQ(choose_local_origin(box(dvec3(3e20), dvec3(3.001e20))), dvec3(3.001e20));
    // The box is a point, as float32 may make of a small and far one.
    EXPECT_EQ(choose_local_origin(box(dvec3(1e6, 0, 0), dvec3(1e6, 0, 0))), dvec3(1e6, 0, 0));
}

TEST(LocalOrigin, NoCoordinateIsThenLargerThanTheExtent) {
    for (double extent = 1e-3; extent < 1e5; extent *= 1.7)
        for (double at = -7e6; at < 7e6; at += 123'456.789) {
            const Bounds64 bounds = box(dvec3(at, -at, 2 * at), dvec3(at + extent, -at + 0.3 * extent, 2 * at));
            const dvec3 origin = choose_local_origin(bounds);
            if (origin == dvec3(0)) continue;
            EXPECT_LE(box(bounds.lo - origin, bounds.hi - origin).reach(), extent * 1.000001) << extent << ' ' << at;
        }
}

TEST(LocalOrigin, PositionsAreRoundedAfterTheOriginIsSubtracted) {
    const std::vector<dvec3> far = {far_away + dvec3(0.13, 0.27, 3.21), dvec3(NAN, 0, INFINITY)};
    const std::vector<vec3> local = local_positions(far, far_away);
    EXPECT_EQ(local[0], vec3(dvec3(far[0] - far_away)));
    EXPECT_NEAR(local[0].y, 0.27, 2e-8);
    EXPECT_TRUE(std::isnan(local[1].x));
    EXPECT_EQ(local[1].z, INFINITY);
    const std::vector<dvec3> near = {dvec3(0.1, -0.0, 1e60)};
    EXPECT_EQ(std::bit_cast<std::uint32_t>(local_positions(near, dvec3(0))[0].y), 0x80000000u);
}

TEST(LocalOrigin, IsWrittenInFull) {
    EXPECT_EQ(origin_text(dvec3(500e3, -5'400'000.25, 0)), "500000 -5400000.25 0");
    EXPECT_EQ(origin_text(dvec3(1e20, 1e-7, 123456789)), "100000000000000000000 0.0000001 123456789");
}

TEST(FarPly, KeepsItsMillimetres) {
    for (const char* type : {"double", "float"}) {
        const Scene scene = load_text(far_houses_ply(type), "a.ply");
        EXPECT_EQ(scene.origin, dvec3(500'010, 5'400'010, 0));
        expect_far_houses(scene, rounding);
        const Scene as_given = load_text(far_houses_ply(type), "a.ply", dvec3(0));
        EXPECT_EQ(as_given.origin, dvec3(0));
        EXPECT_EQ(as_given.meshes[0].positions[1].x, static_cast<float>(500'010.13));
        const Scene chosen = load_text(far_houses_ply(type), "a.ply", far_away + 3.5);
        EXPECT_EQ(chosen.origin, far_away + 3.5);
        expect_far_houses(chosen, rounding);
    }
}

TEST(FarPly, StrayVerticesThatNoFaceUsesDoNotCount) {
    std::string file = far_houses_ply("double");
    file.replace(file.find("vertex 32"), 9, "vertex 33");
    const std::size_t body = file.find("end_header\n") + 11;
    std::string lines = file.substr(body);
    std::size_t end = 0;
    for (int i = 0; i < 32; ++i) end = lines.find('\n', end) + 1;
    lines.insert(end, "0 0 0\n");
    EXPECT_EQ(load_text(file.substr(0, body) + lines, "a.ply").origin, dvec3(500'010, 5'400'010, 0));
}

TEST(FarGltf, NodesAreComposedInFloat64) {
    GltfBuilder gltf = far_houses_gltf();
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.origin, dvec3(500'010, 5'400'010, 0));
    EXPECT_EQ(scene.meshes.size(), 1u);
    expect_far_houses(scene, rounding);
    // All nodes are below one that has moved them there.
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

// Makes a triangle whose vertices are themselves large, in halves of a metre, which is what float32 has there.
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
    // A node brings the vertices back, once with a turn.
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
    const Scene scene = load_text(back.with_data_uri(), "a.gltf", dvec3(0));
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

// Node 0 goes 1.5 m east within a second; key frames are in the file's coordinates.
TEST(FarGltf, PosesOfAnAnimationAreRelativeToTheOrigin) {
    GltfBuilder gltf = one_triangle();
    gltf.root["nodes"][0]["translation"] = {far_away.x + 0.5, far_away.y, far_away.z};
    gltf.animate(0, "translation", {0, 1}, "VEC3", {500'000.5f, 5.4e6f, 0, 500'002, 5.4e6f, 0});
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
    gltf.animate(0, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, 1, 0});
    Scene scene = gltf.load();
    pose_scene(scene, pose_at(*scene.rig, scene.rig->animations[0], 1));  // half a turn about 0, so far away
    const dvec3 corner =
        scene.origin + dvec3(transform_point(scene.instances[0].transform, scene.meshes[0].positions[1]));
    EXPECT_NEAR(corner.x, -500'010.25, 0.5);
    EXPECT_NEAR(corner.y, -5'400'000, 0.5);
}

// Makes a triangle that follows one joint, bound where it is; `bind` and `place` are the joint's.
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
    turning.animate(1, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, 1, 0});
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
    const Scene scene = load_text(gltf.with_data_uri(), "a.gltf", dvec3(5, 0, 0));
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
