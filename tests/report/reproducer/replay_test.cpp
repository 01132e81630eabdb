#include "report/replay/replay.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include <twinray/scene.h>

#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "tests/scene/temp_dir.h"

namespace twinray::replay {
namespace {

// Floats without a short decimal form, a degenerate triangle, an empty mesh, uneven and mirrored instances.
Scene hard_scene() {
    Mesh soup = make_soup(50, 3, 0.3f);
    for (vec3& p : soup.positions) p = p * vec3(0x1.fffffep-30f, 0.1f, 1e17f);
    soup.triangles.insert(soup.triangles.begin() + 7, uvec3(0, 0, 1));
    Scene scene;
    scene.meshes = {soup, Mesh{}, make_icosphere(1)};
    scene.instances = {
        {"", 0, Transform{}},
        {"", 0, Transform{{vec4(0.1f, 0.2f, 0.3f, 0x1p-120f), vec4(-0.7f, 1e-9f, 0, 3), vec4(0, 0, -1e8f, -0.1f)}}},
        {"", 1, Transform::translation({1, 2, 3})},
        {"", 2, Transform::scaling({-1, 0.001f, 1})}};
    return scene;
}

TEST(SceneFile, KeepsEveryTriangleAndTransformThatRaysCanTell) {
    const test::TempDir folder;
    const ReferenceScene reference = ReferenceScene::of(hard_scene());
    const Scene written = scene_of(reference);
    write_glb(folder / "scene.glb", written);
    const Scene loaded = load_scene(folder / "scene.glb", dvec3(0));
    EXPECT_EQ(hash_of(loaded), hash_of(written));
    const ReferenceScene again = ReferenceScene::of(loaded);
    ASSERT_EQ(again.instance_count(), reference.instance_count());
    for (uint i = 0; i < reference.instance_count(); ++i) {
        EXPECT_EQ(again.placement(i).to_world, reference.placement(i).to_world);
        EXPECT_EQ(again.placement(i).offset, reference.placement(i).offset);
        ASSERT_EQ(again.geometry(i).active().size(), reference.geometry(i).active().size());
        for (const ActiveTriangle& triangle : reference.geometry(i).active()) {
            const ActiveTriangle* same = again.geometry(i).find(triangle.primitive);
            ASSERT_NE(same, nullptr);
            EXPECT_EQ(same->vertices, triangle.vertices);
        }
    }
}

TEST(SceneFile, TheHashTellsScenesApart) {
    Scene scene = hard_scene();
    const std::string hash = hash_of(scene);
    EXPECT_EQ(hash.size(), 16u);
    scene.meshes[0].positions[5].y = std::nextafter(scene.meshes[0].positions[5].y, 1.0f);
    EXPECT_NE(hash_of(scene), hash);
    scene = hard_scene();
    scene.instances[1].transform.rows[2].w = 0;
    EXPECT_NE(hash_of(scene), hash);
}

Replay example() {
    Replay replay;
    replay.scene = "../scenes/a b.glb";
    replay.scene_hash = "0123456789abcdef";
    replay.backend = "hw";
    replay.level = "watertight";
    replay.kind = "HW_LEAK";
    replay.ray = {vec3(0.1f, -0.0f, 0x1p-149f), 0.3f, vec3(1.0f / 3, 1e30f, -7), INFINITY};
    replay.answer = {1, 1.0f / 7, 4, 0, 0.1f, 0.7f, 2, 0};
    replay.reference = {true, 1.0 / 7, 0.1, 0.7, 4, 2, 0};
    replay.device = "a \"quoted\" device";
    return replay;
}

TEST(ReplayFile, KeepsEveryBit) {
    const test::TempDir folder;
    const Replay replay = example();
    write(folder / "a.json", replay);
    const Replay again = read(folder / "a.json");
    EXPECT_EQ(std::memcmp(&again.ray, &replay.ray, sizeof(Ray)), 0);
    EXPECT_EQ(std::memcmp(&again.answer, &replay.answer, sizeof(Hit)), 0);
    EXPECT_EQ(again.reference, replay.reference);
    EXPECT_EQ(again.scene, replay.scene);
    EXPECT_EQ(again.scene_hash + again.backend + again.level + again.kind + again.device,
              replay.scene_hash + replay.backend + replay.level + replay.kind + replay.device);
}

TEST(ReplayFile, AMissIsNoHit) {
    const test::TempDir folder;
    Replay replay = example();
    replay.answer = miss();
    replay.reference = {};
    write(folder / "a.json", replay);
    EXPECT_EQ(read(folder / "a.json").answer.hit, 0u);
    EXPECT_EQ(read(folder / "a.json").answer.t, -1);
    EXPECT_FALSE(read(folder / "a.json").reference.hit);
}

TEST(ReplayFile, WhatIsNoReplayIsRefusedByName) {
    const test::TempDir folder;
    const auto refused = [&](const std::string& text) {
        const std::filesystem::path file = folder.write("bad.json", text);
        return test::error_if_any([&] { static_cast<void>(read(file)); }).find("bad.json") != std::string::npos;
    };
    write(folder / "a.json", example());
    std::ifstream in(folder / "a.json");
    const std::string good(std::istreambuf_iterator<char>(in), {});
    EXPECT_FALSE(refused(good));
    EXPECT_TRUE(refused(""));
    EXPECT_TRUE(refused("[1]"));
    EXPECT_TRUE(refused(good.substr(0, good.size() / 2)));
    for (const std::string word : {"twinray-replay/1", "0x1.333334p-2", "t_max"}) {
        ASSERT_NE(good.find(word), std::string::npos) << word;
        EXPECT_TRUE(refused(std::string(good).replace(good.find(word), word.size(), "x"))) << word;
    }
    EXPECT_THROW(static_cast<void>(read(folder / "none.json")), Error);
}

}  // namespace
}  // namespace twinray::replay
