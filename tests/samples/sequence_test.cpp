// SPDX-License-Identifier: MIT
// The moment, view and file of each picture of a sequence.
#include "renderer/sequence.h"

#include <gtest/gtest.h>

#include <twinray/scene.h>

#include <twinray/geometry.h>
#include "engine/scene/rig.h"
#include "tests/scene/temp_dir.h"

namespace twinray::path_tracer {
namespace {

// Makes a box that is carried from x = 0 at 1 s to x = 8 at 3 s, and a second animation with a fault.
Scene carried_box() {
    Scene scene;
    scene.meshes = {make_box({0, 0, 0}, {1, 1, 1})};
    scene.materials.push_back({});
    scene.instances = {{"box", 0, {}}};
    auto rig = std::make_shared<Rig>();
    rig->nodes.resize(1);
    rig->instances = {{.node = 0}};
    Animation ride{.name = "ride", .keyframes = {}, .channels = {}, .fault = {}};
    ride.keyframes = {{Interpolation::linear, false, 3, {1, 3}, {0, 0, 0, 8, 0, 0}}};
    ride.channels = {{0, Animation::Channel::Path::translation, 0}};
    rig->animations = {ride, {.name = "bad", .keyframes = {}, .channels = {}, .fault = "broken"}};
    scene.rig = rig;
    return scene;
}

TEST(Sequence, FramesShareTheRangeOrKeepToTheirRate) {
    const Scene scene = carried_box();
    const Sequence even = make_sequence({.frames = 4}, scene);
    EXPECT_EQ(even.time_of(0), 1);
    EXPECT_EQ(even.time_of(3), 2.5);
    const Sequence timed = make_sequence({.frames = 9, .fps = 2.0}, scene);
    EXPECT_EQ(timed.time_of(3), 2.5);
    EXPECT_EQ(timed.time_of(4), 1);  // and anew
    const Sequence part = make_sequence({.frames = 2, .time_range = "1.5:2"}, scene);
    EXPECT_EQ(part.time_of(1), 1.75);
    EXPECT_EQ(make_sequence({.frames = 2, .time_range = "2:2"}, scene).time_of(1), 2);
}

TEST(Sequence, AnimationsAreChosenByNameOrIndex) {
    const Scene scene = carried_box();
    EXPECT_EQ(make_sequence({.frames = 1}, scene).animation, 0u);
    EXPECT_EQ(make_sequence({.frames = 1, .animation = "ride"}, scene).animation, 0u);
    EXPECT_EQ(make_sequence({.frames = 1, .animation = "0", .turntable = true}, scene).animation, 0u);
    EXPECT_EQ(make_sequence({.frames = 1, .turntable = true}, scene).animation, std::nullopt);
    EXPECT_EQ(make_sequence({.frames = 1, .turntable = true}, Scene()).animation, std::nullopt);
}

TEST(Sequence, WhatCannotBePlayedIsNamed) {
    const Scene scene = carried_box();
    const auto expect = [](const SequenceOptions& options, const Scene& of, const char* part) {
        test::expect_error(part, [&] { make_sequence(options, of); });
    };
    expect({.frames = 1}, Scene(), "has no animations");
    expect({.frames = 1, .animation = "walk"}, scene, "'walk': does not exist; the scene has 0 'ride', 1 'bad'");
    expect({.frames = 1, .animation = "2"}, scene, "does not exist");
    expect({.frames = 1, .animation = "bad"}, scene, "cannot be played: broken");
    expect({.frames = 1, .time_range = "2:1"}, scene, "must be A:B");
    expect({.frames = 1, .time_range = "2"}, scene, "must be A:B");
    expect({.frames = 1, .time_range = "1:2x"}, scene, "must be A:B");
    expect({.frames = 1, .fps = 24.0, .turntable = true}, scene, "unless --animation names it");
}

TEST(Sequence, FilesAreNumberedFromOne) {
    EXPECT_EQ(frame_file("a/out.png", 0), "a/out_0001.png");
    EXPECT_EQ(frame_file("out.exr", 12344), "out_12345.exr");
    EXPECT_EQ(frame_file("a#/f##-###b.png", 6), "a#/f##-007b.png");
    EXPECT_EQ(frame_file("#.png", 10), "11.png");
}

TEST(Sequence, ATurntableGoesRoundOnce) {
    const Sequence sequence{.frames = 4, .turntable = true};
    Camera camera;
    camera.camera_to_world = Transform::translation({2, 5, 3});
    const Camera turned = turned_about(camera, {2, 0, 0}, sequence.angle_of(1));  // by a quarter
    const vec3 eye = transform_point(turned.camera_to_world, vec3(0));
    const vec3 ahead = transform_vector(turned.camera_to_world, vec3(0, 0, -1));
    const vec3 expected[] = {{5, 5, 0}, {-1, 0, 0}};
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(eye[i], expected[0][i], 1e-6);
        EXPECT_NEAR(ahead[i], expected[1][i], 1e-6);
    }
    EXPECT_NEAR(sequence.angle_of(3), 3 * sequence.angle_of(1), 1e-12);
}

TEST(Sequence, WhatIsSweptHoldsAllMoments) {
    const Scene scene = carried_box();
    const Scene all = swept(scene, make_sequence({.frames = 4}, scene));
    EXPECT_EQ(bounds_of(all).lo, vec3(0));
    EXPECT_EQ(bounds_of(all).hi, vec3(7, 1, 1));
}

// A box is hidden at rest and grows at x = 100: its place before it is played does not count.
TEST(Sequence, WhatIsSweptHoldsWhatGrowsFromNothing) {
    Scene scene = carried_box();
    scene.instances.push_back({"seed", 0, Transform::translation({0, -50, 0})});
    auto rig = std::make_shared<Rig>(*scene.rig);
    rig->nodes.push_back({.name = "seed", .rest = {.translation = {100, 0, 0}, .scale = {0, 0, 0}}, .weights = {}});
    rig->instances.push_back({.node = 1});
    rig->animations[0].keyframes.push_back({Interpolation::linear, false, 3, {1, 3}, {0, 0, 0, 2, 2, 2}});
    rig->animations[0].channels.push_back({1, Animation::Channel::Path::scale, 1});
    scene.rig = rig;
    const Scene all = swept(scene, make_sequence({.frames = 2}, scene));  // at 1 s and 2 s
    EXPECT_EQ(bounds_of(all).lo, vec3(0));
    EXPECT_EQ(bounds_of(all).hi, vec3(101, 1, 1));
    for (const Instance& instance : all.instances) EXPECT_EQ(fault_of(instance.transform), "");
}

TEST(Sequence, HiddenInstancesAreOfAnimationsThatPlay) {
    EXPECT_FALSE(SequenceOptions{}.plays_animation());
    EXPECT_TRUE(SequenceOptions{.frames = 1}.plays_animation());
    EXPECT_FALSE((SequenceOptions{.frames = 1, .turntable = true}).plays_animation());
    EXPECT_TRUE((SequenceOptions{.frames = 1, .animation = "0", .turntable = true}).plays_animation());
}

}  // namespace
}  // namespace twinray::path_tracer
