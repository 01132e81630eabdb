// Cameras: what their rays see, how lenses and filters spread them, and how scenes are framed, exposed and lit; and the
// moment, view and file of each picture of a sequence.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "engine/core/error.h"
#include "engine/scene/rig.h"
#include "renderer/camera.h"
#include "renderer/lights.h"
#include "renderer/reference.h"
#include "renderer/sequence.h"
#include "tests/scene/temp_dir.h"

namespace twinray::path_tracer {
namespace {

Scene scene_of(Mesh mesh) {
    Scene scene;
    scene.materials.push_back({});
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({"instance", 0, {}});
    return scene;
}

vec3 backward_of(const Camera& camera) {
    return {camera.camera_to_world.rows[0].z, camera.camera_to_world.rows[1].z, camera.camera_to_world.rows[2].z};
}

TEST(FrameScene, ShowsTheWholeBox) {
    const Scene scene = scene_of(make_box({3, -1, 5}, {9, 1, 6}));
    for (const float aspect : {0.5f, 1.0f, 2.0f}) {
        const CameraRays rays = camera_rays(frame_scene(scene, aspect), aspect);
        float widest = 0;
        for (const vec3& corner : scene.meshes[0].positions) {
            const vec3 way = corner - rays.origin;
            const float depth = dot(way, rays.forward);
            EXPECT_GT(depth, 0);
            const float x = dot(way, rays.right) / dot(rays.right, rays.right) / depth;
            const float y = dot(way, rays.up) / dot(rays.up, rays.up) / depth;
            widest = std::max({widest, std::abs(x), std::abs(y)});
        }
        EXPECT_LT(widest, 1) << aspect;
        EXPECT_GT(widest, 0.8f) << aspect;
    }
}

TEST(FrameScene, LooksIntoOpenRoomsAndAtPictures) {
    EXPECT_GT(backward_of(frame_scene(cornell_box_scene(), 1)).z, 0.95f);
    EXPECT_GT(backward_of(frame_scene(scene_of(make_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1})), 1)).x, 0.9f);
}

TEST(FrameScene, SeesClosedObjectsFromTheFrontRightAndAbove) {
    const vec3 backward = backward_of(frame_scene(scene_of(make_icosphere(2)), 1));
    EXPECT_TRUE(backward.x > 0.2f && backward.y > 0.2f && backward.z > 0.6f);
}

TEST(CameraRays, OrthographicRaysAreParallel) {
    Camera camera;
    camera.orthographic_half_height = 2.0f;
    const CameraRays rays = camera_rays(camera, 1.5f);
    EXPECT_EQ(rays.orthographic, 1u);
    EXPECT_EQ(rays.right, vec3(3, 0, 0));
    EXPECT_EQ(rays.up, vec3(0, 2, 0));
    EXPECT_EQ(rays.forward, vec3(0, 0, -1));
}

// All of a frame is seen at the scale of its tighter side, with more beside it.
TEST(CameraRays, PicturesOfAnotherAspectShowAllOfTheFrame) {
    for (const bool is_orthographic : {false, true})
        for (const float frame : {0.5f, 1.0f, 2.0f})
            for (const float aspect : {0.25f, 1.0f, 1.5f, 3.0f}) {
                Camera camera;
                camera.aspect = frame;
                if (is_orthographic) camera.orthographic_half_height = 2.0f;
                const float half = is_orthographic ? 2 : std::tan(camera.vertical_fov / 2);
                const CameraRays rays = camera_rays(camera, aspect);
                EXPECT_NEAR(rays.right.x / rays.up.y, aspect, 1e-6f);  // not stretched
                const float over = std::min(rays.right.x / (half * frame), rays.up.y / half);
                EXPECT_NEAR(over, 1, 1e-6f) << frame << " in " << aspect;
                camera.aspect.reset();
                EXPECT_EQ(camera_rays(camera, aspect).up.y, half) << "without a frame the height is what is seen";
            }
}

TEST(AutomaticExposure, BringsTheMeanToMiddleGrey) {
    HdrImage picture{2, 2, {vec3(0), vec3(2), vec3(8), vec3(4)}};
    EXPECT_NEAR(std::exp2(automatic_exposure(picture)) * 4, 0.18f, 1e-5f);
    EXPECT_EQ(automatic_exposure({1, 1, {vec3(0)}}), 0);
}

TEST(LocalLights, OfATableAreChosenByTheirPower) {
    Scene scene = cornell_box_scene();
    scene.lights.push_back({.name = "light", .kind = Light::Kind::point, .color = vec3(1)});
    const LocalLights lights = collect_lights(scene, LightChoice::table);
    ASSERT_EQ(lights.emitters.size(), 2u);
    ASSERT_EQ(lights.punctual.size(), 1u);
    const double light = static_cast<double>(PI * 0.25f * luminance(vec3(15, 13.5f, 11))),
                 point = static_cast<double>(4 * PI);
    EXPECT_NEAR(lights.punctual[0].chance, point / (light + point), 1e-5);
    EXPECT_NEAR(lights.densities[lights.emitters[0].instance][0], light / (light + point) / 0.25, 1e-4);
}

TEST(LocalLights, OfNoPowerStillMakeATableThatCanBeRead) {
    Scene scene;
    scene.lights = {{.name = "lamp", .kind = Light::Kind::point, .color = vec3(0)}};
    const LocalLights tree = collect_lights(scene, LightChoice::tree);
    EXPECT_LT(tree.table_first, tree.table.size());
    EXPECT_EQ(tree.punctual[0].chance, 0);
}

TEST(LocalLights, SunsAndLampsHaveTheSameShare) {
    Scene scene = cornell_box_scene();
    scene.lights = {{.name = "sun", .kind = Light::Kind::directional, .color = vec3(1e5f)},
                    {.name = "lamp", .kind = Light::Kind::point, .color = vec3(1)},
                    {.name = "moon", .kind = Light::Kind::directional, .color = vec3(3e5f)}};
    const LocalLights tree = collect_lights(scene), table = collect_lights(scene, LightChoice::table);
    EXPECT_EQ(tree.by, LightChoice::tree);
    EXPECT_EQ(tree.kind_count(), 2u);
    EXPECT_EQ(tree.table_chance, 0.5f);
    EXPECT_EQ(tree.table_first, 3u);
    EXPECT_EQ(tree.table_count, 2u);
    EXPECT_EQ(table.table_chance, 1.0f);
    EXPECT_EQ(table.table_count, 5u);
    EXPECT_EQ(tree.punctual[0].chance, 1) << "alone in its leaf";
    for (const int sun : {1, 2}) {
        EXPECT_NEAR(tree.punctual[sun].chance, sun == 2 ? 0.75 : 0.25, 1e-6) << "of the suns";
        EXPECT_NEAR(table.punctual[sun].chance, sun == 2 ? 0.375 : 0.125, 1e-6);
    }
    EXPECT_NEAR(tree.densities[tree.emitters[0].instance][0], 0.5 / 0.125, 1e-4) << "half of a square";
}

TEST(LocalLights, TheHalvesOfASquareAreOneLamp) {
    Scene scene = cornell_box_scene();
    EXPECT_EQ(collect_lights(scene).by, LightChoice::table) << "the box has one lamp";
    scene.lights = {{.name = "lamp", .kind = Light::Kind::point, .color = vec3(1)}};
    const LocalLights lights = collect_lights(scene);
    EXPECT_EQ(lights.tree.nodes.size(), 3u);
    EXPECT_EQ(lights.tree.ways[0], lights.tree.ways[1]);
    EXPECT_NE(lights.tree.ways[0], lights.tree.ways[2]);
}

TEST(HasLamps, TellsLampsFromGlowingLabels) {
    Scene scene = scene_of(make_icosphere(0));
    scene.materials[0].emission = vec3(1);
    EXPECT_FALSE(has_lamps(scene));
    scene.materials[0].emission = vec3(5);
    EXPECT_TRUE(has_lamps(scene));
}

TEST(LookCamera, StandsWhereItIsToldAndLooksThere) {
    const CameraRays rays = camera_rays(look_camera({1, 2, 3}, {1, 2, -7}, {0, 5, 0}, 90), 2);
    EXPECT_EQ(rays.origin, vec3(1, 2, 3));
    EXPECT_EQ(rays.forward, vec3(0, 0, -1));
    EXPECT_NEAR(length(rays.right - vec3(2, 0, 0)), 0, 1e-6f);
    EXPECT_NEAR(length(rays.up - vec3(0, 1, 0)), 0, 1e-6f);
    const CameraRays tilted = camera_rays(look_camera({0, 4, 4}, vec3(0), {0, 1, 0}, 40), 1);
    EXPECT_NEAR(dot(tilted.forward, tilted.up), 0, 1e-6f);
    EXPECT_GT(tilted.up.y, 0);
    EXPECT_THROW(look_camera(vec3(1), vec3(1), {0, 1, 0}, 40), Error);
    EXPECT_THROW(look_camera({0, 2, 0}, vec3(0), {0, 1, 0}, 40), Error);
    EXPECT_THROW(look_camera({0, NAN, 0}, vec3(0), {1, 0, 0}, 40), Error);
}

TEST(Reference, ErrorsAreMeansOverPixelsAndChannels) {
    const HdrImage picture{2, 1, {vec3(1, 2, 3), vec3(0)}};
    const PictureError error = error_against(picture, {2, 1, {vec3(1, 2, 1), vec3(0, 0, 0.1f)}});
    EXPECT_NEAR(error.mse, (4 + 0.01) / 6, 1e-6);
    EXPECT_NEAR(error.relative_mse, (4 / 1.01 + 0.01 / 0.02) / 6, 1e-6);
}

// Stratified in both dimensions.
template <class F>
std::vector<vec2> points_of(F warp, uint side = 512) {
    std::vector<vec2> points;
    for (uint y = 0; y < side; ++y)
        for (uint x = 0; x < side; ++x) points.push_back(warp((vec2(x, y) + 0.5f) / static_cast<float>(side)));
    return points;
}

// Returns the largest difference between the share of values below x and the wanted distribution (Kolmogorov and
// Smirnov).
double distance_of(std::vector<float> values, const std::function<double(double)>& distribution) {
    std::sort(values.begin(), values.end());
    double largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        largest = std::max(largest, std::abs(distribution(double{values[i]}) -
                                             (static_cast<double>(i) + 0.5) / static_cast<double>(values.size())));
    return largest;
}

TEST(Filter, SamplesAreDistributedAsTheFilterSays) {
    const auto box = [](double x) { return std::clamp(x + 0.5, 0.0, 1.0); };
    const auto triangle = [](double x) { return x < 0 ? (1 + x) * (1 + x) / 2 : 1 - (1 - x) * (1 - x) / 2; };
    const auto gaussian = [](double x) { return 0.5 * std::erfc(-x / 0.5 / std::sqrt(2.0)); };
    const std::pair<uint, std::function<double(double)>> filters[] = {
        {FILTER_BOX, box}, {FILTER_TRIANGLE, triangle}, {FILTER_GAUSSIAN, gaussian}};
    for (const auto& [kind, distribution] : filters) {
        const auto points = points_of([kind = kind](vec2 u) { return filter_offset(kind, u); });
        for (const int axis : {0, 1}) {
            std::vector<float> values;
            for (const vec2& point : points) values.push_back(point[axis]);
            EXPECT_LT(distance_of(values, distribution), 0.002) << "filter " << kind << " axis " << axis;
        }
        double product = 0;
        for (const vec2& point : points) product += double{point.x} * double{point.y};
        EXPECT_NEAR(product / static_cast<double>(points.size()), 0, 1e-4) << "filter " << kind;
    }
}

TEST(Filter, EveryRandomNumberHasAFiniteOffset) {
    const float last = unit_float(0xffffffffu);
    for (const uint kind : {FILTER_BOX, FILTER_TRIANGLE, FILTER_GAUSSIAN})
        for (const vec2 u : {vec2(0), vec2(last), vec2(0, last), vec2(last, 0)})
            EXPECT_LT(length(filter_offset(kind, u)), 3) << "filter " << kind;
}

CameraRays tilted_camera(bool is_orthographic) {
    Camera camera = look_camera({1, 2, 3}, {-4, 0, 1}, {0, 1, 0}, 50);
    if (is_orthographic) camera.orthographic_half_height = 2;
    return camera_rays(camera, 1.5f);
}

TEST(Lens, RaysOfAPointMeetOnTheFocalPlane) {
    for (const bool is_orthographic : {false, true}) {
        CameraRays camera = tilted_camera(is_orthographic);
        const vec2 at(0.3f, -0.8f);
        const Ray pinhole = camera_ray(camera, at, vec2(0.7f));
        const vec3 sharp = pinhole.origin + pinhole.direction * (7 / dot(pinhole.direction, camera.forward));
        camera.lens_radius = 0.25f;
        camera.focal_distance = 7;
        for (const vec2& u : points_of([](vec2 v) { return v; }, 8)) {
            const Ray ray = camera_ray(camera, at, u);
            EXPECT_NEAR(length(ray.direction), 1, 1e-6f);
            EXPECT_NEAR(dot(ray.origin - pinhole.origin, camera.forward), 0, 1e-6f);
            EXPECT_NEAR(length(cross(sharp - ray.origin, ray.direction)), 0, 3e-6f);
        }
    }
}

TEST(Lens, MayFocusAnywhere) {
    CameraRays camera = tilted_camera(false);
    const Ray pinhole = camera_ray(camera, vec2(0), vec2(0));
    camera.lens_radius = 0.25f;
    camera.focal_distance = std::numeric_limits<float>::max();
    EXPECT_EQ(camera_ray(camera, vec2(0), vec2(0.3f)).direction, pinhole.direction);
}

TEST(Lens, RaysStartUniformlyOnADisk) {
    CameraRays camera = tilted_camera(false);
    camera.lens_radius = 0.25f;
    camera.focal_distance = 7;
    std::vector<float> radii, turns;
    for (const vec2& offset : points_of([&](vec2 u) {
             const vec3 way = camera_ray(camera, vec2(0), u).origin - camera.origin;
             return vec2(dot(way, normalize(camera.right)), dot(way, normalize(camera.up)));
         })) {
        radii.push_back(length(offset));
        turns.push_back(std::atan2(offset.y, offset.x));
    }
    EXPECT_LT(distance_of(radii, [](double r) { return r * r * 16; }), 0.002);
    EXPECT_LT(distance_of(turns, [](double angle) { return angle / (2 * std::numbers::pi) + 0.5; }), 0.002);
}

TEST(Lens, OfNoSizeIsAPinhole) {
    CameraRays camera = tilted_camera(false);
    const Ray expected = camera_ray(camera, {0.5f, 0.5f}, vec2(0));
    camera.focal_distance = 3;
    const Ray ray = camera_ray(camera, {0.5f, 0.5f}, vec2(0.9f));
    EXPECT_EQ(ray.origin, expected.origin);
    EXPECT_EQ(ray.direction, expected.direction);
}

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
