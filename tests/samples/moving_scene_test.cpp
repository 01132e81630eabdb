// A moved scene equals a scene that was made in that place.
#include "renderer/moving_scene.h"

#include <limits>

#include "engine/scene/rig.h"
#include "engine/core/error.h"
#include "renderer/reference.h"
#include "tests/samples/render.h"

namespace twinray::path_tracer {
namespace {

Keyframes keyframes(uint width, std::vector<float> values) {
    return {Interpolation::linear, false, width, {0, 1}, std::move(values)};
}

// Makes a floor, a lamp that an animation widens by a morph target, and a box and a light that it moves. All numbers
// are short, so that float32 and float64 agree on where things are.
Scene moving_scene() {
    Scene scene;
    add(scene, make_quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}), lambert(0.5f));
    add(scene, make_quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}), lamp(4));
    add(scene, make_box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}), lambert(0.75f));
    scene.lights = {{.name = "light", .color = vec3(2), .position = {0, 2, 0}}};
    auto rig = std::make_shared<Rig>();
    rig->nodes.resize(3);  // 0 stays, 1 carries the lamp, 2 box and light
    rig->nodes[1].weights = {0};
    rig->instances = {{.node = 0}, {.node = 1}, {.node = 2}};
    rig->lights = {{.node = 2, .local = matrix_of(Trs{.translation = {0, 2, 0}})}};
    DeformedMesh wide{1, 1, -1, {scene.meshes[1].positions, {}, {}}, {}};
    wide.motion.targets = {{{{-2, 0, 0}, {2, 0, 0}, {2, 0, 0}, {-2, 0, 0}}, {}, {}}};
    rig->meshes = {wide};
    Animation animation{.name = "all", .keyframes = {}, .channels = {}, .fault = {}};
    using Path = Animation::Channel::Path;
    animation.keyframes = {keyframes(1, {0, 1}), keyframes(3, {0, 0, 0, 2, 0, -1}), keyframes(3, {1, 1, 1, 0, 0, 0})};
    animation.channels = {{1, Path::weights, 0}, {2, Path::translation, 1}};
    rig->animations = {animation};
    animation.channels = {{1, Path::scale, 2}};
    rig->animations.push_back(animation);  // the lamp vanishes
    scene.rig = rig;
    return scene;
}

class MovingSceneTest : public test::VulkanTest {
  protected:
    // The pictures before and after the move, and that of a scene made as it is after the move.
    struct Pictures {
        HdrImage before, after, expected;
    };
    // The first two are made with all features if `everything` is true.
    Pictures pictures(Scene scene, const Pose& pose, bool hardware, bool everything = false) {
        RenderSetup setup = seen_from({0, 6, 9}, {0, 1, 0}, 0.4f);
        setup.settings.samples = 2;
        setup.hardware = hardware;
        Scene made = scene;
        const LocalLights lights = collect_lights(scene);
        DeviceScene device_scene(context(), scene, lights, nullptr,
                                 everything ? all_features(scene) : features_of(scene, lights, nullptr));
        Renderer renderer(context(), device_scene, setup.settings);
        const std::unique_ptr<AbstractAccel> accel = make_accel(context(), hardware);
        push_scene(*accel, scene);
        accel->sync();
        Pictures result;
        result.before = render_picture(renderer, setup.settings, *accel, true);
        MovingScene moving(context(), scene, device_scene, *accel);
        const std::uint64_t revision = accel->revision();
        moving.move_to(pose);
        EXPECT_EQ(accel->revision(), revision);
        result.after = render_picture(renderer, setup.settings, *accel, true);
        pose_scene(made, pose);
        for (const DeformedMesh& mesh : made.rig->meshes)
            made.meshes[mesh.mesh].positions = deformed(*made.rig, mesh, pose).positions;
        std::erase_if(made.instances, [](const Instance& i) { return !fault_of(i.transform).empty(); });
        result.expected = render(context(), made, setup);
        return result;
    }
};

TEST_F(MovingSceneTest, IsAsIfItHadBeenMadeSo) {
    const Scene scene = moving_scene();
    for (const bool hardware : {false, true}) {
        if (hardware && !missing_for_hardware(context().properties()).empty())
            TWINRAY_LACKS("ray_tracing", "no ray tracing extensions");
        SCOPED_TRACE(hardware ? "hw" : "sw");
        const Pictures found = pictures(scene, pose_at(*scene.rig, scene.rig->animations[0], 0.5), hardware);
        EXPECT_FALSE(same_bits(found.before, found.after));
        EXPECT_TRUE(same_bits(found.after, found.expected));
    }
}

// A lamp and a sun are chosen from a table, also by kernels that know trees.
TEST_F(MovingSceneTest, KernelsWithEveryFeatureMakeTheSamePicture) {
    Scene scene = moving_scene();
    scene.lights = {{.name = "sun", .kind = Light::Kind::directional, .color = vec3(1), .direction = {0, -1, 0}}};
    auto rig = std::make_shared<Rig>(*scene.rig);
    rig->lights = {{.node = 0}};
    scene.rig = rig;
    const Pictures found = pictures(scene, pose_at(*rig, rig->animations[0], 0.5), false, true);
    EXPECT_LT(error_against(found.after, found.expected).relative_mse, 1e-9);
}

TEST_F(MovingSceneTest, ALampThatVanishesShinesNoMore) {
    Scene scene = moving_scene();
    const Pose pose = pose_at(*scene.rig, scene.rig->animations[1], 1);
    const Pictures lit = pictures(scene, pose, false);
    EXPECT_TRUE(same_bits(lit.after, lit.expected));
    scene.lights.clear();
    const Pictures dark = pictures(scene, pose, false);
    EXPECT_GT(statistics(dark.before).mean, 0);
    EXPECT_EQ(statistics(dark.after).mean, 0);
}

// The box, which has no size at rest, grows.
TEST_F(MovingSceneTest, WhatIsHiddenAtRestAppears) {
    Scene scene = moving_scene();
    auto rig = std::make_shared<Rig>(*scene.rig);
    rig->nodes[2].rest.scale = dvec3(0);
    rig->hidden = {{scene.instances[2], rig->instances[2]}};
    rig->instances.pop_back();
    rig->animations[0].keyframes[2] = keyframes(3, {0, 0, 0, 1, 2, 1});
    rig->animations[0].channels = {{2, Animation::Channel::Path::scale, 2}};
    scene.instances.pop_back();
    scene.rig = rig;
    show_hidden(scene);
    const auto at = [&](double seconds) {
        return pictures(scene, pose_at(*scene.rig, scene.rig->animations[0], seconds), false);
    };
    const Pictures none = at(0), grown = at(1);
    EXPECT_TRUE(same_bits(none.after, none.expected));
    EXPECT_TRUE(same_bits(grown.after, grown.expected));
    EXPECT_FALSE(same_bits(none.after, grown.after));
}

// Targets and skins leave normals without a direction.
TEST_F(MovingSceneTest, NormalsThatVanishAreThoseOfTheTriangle) {
    for (const float left : {0.0f, std::numeric_limits<float>::quiet_NaN()}) {
        Scene scene = moving_scene();
        scene.meshes[0].normals.assign(4, vec3(0, 1, 0));
        auto rig = std::make_shared<Rig>(*scene.rig);
        rig->nodes[0].weights = {1};
        DeformedMesh floor{0, 0, -1, {scene.meshes[0].positions, scene.meshes[0].normals, {}}, {}};
        floor.motion.targets = {{std::vector<vec3>(4, vec3(0)), std::vector<vec3>(4, vec3(left, -1, 0)), {}}};
        rig->meshes.push_back(floor);
        scene.rig = rig;
        scene.meshes[0].normals.assign(4, normalize(vec3(0.5f, 1, 0)));
        Scene flat = scene;
        flat.meshes[0].normals.clear();
        const Pose pose = rest_pose(*rig);
        const Pictures found = pictures(scene, pose, false), expected = pictures(flat, pose, false);
        EXPECT_FALSE(same_bits(found.before, expected.before));
        EXPECT_TRUE(same_bits(found.after, expected.expected));
    }
}

TEST_F(MovingSceneTest, LightInASceneThatWasDarkIsRefused) {
    Scene scene = moving_scene();
    scene.lights.clear();
    scene.meshes[1].positions[1] = scene.meshes[1].positions[2] = scene.meshes[1].positions[0];  // no area
    DeviceScene device_scene(context(), scene, collect_lights(scene), nullptr);
    SwTlas accel(context());
    push_scene(accel, scene);
    accel.sync();
    MovingScene moving(context(), scene, device_scene, accel);
    EXPECT_THROW(moving.move_to(rest_pose(*scene.rig)), Error);
}

// One mesh has two instances, the second with a material of its own.
TEST_F(MovingSceneTest, InstancesMayHaveMaterialsOfTheirOwn) {
    Scene own = moving_scene(), shared = own;
    own.rig = shared.rig = nullptr;
    add(own, own.meshes[1], lambert(0.25f), Transform::translation({0, -1, 0}));
    shared.materials = own.materials;
    shared.instances.insert(shared.instances.begin() + 2, {"dark lamp", 1, Transform::translation({0, -1, 0}), 3});
    shared.instances[3].material = 0;
    own.meshes[2].materials.assign(own.meshes[2].triangles.size(), 0);
    RenderSetup setup = seen_from({0, 6, 9}, {0, 1, 0}, 0.4f);
    setup.settings.samples = 16;
    const Statistics expected = statistics(render(context(), own, setup));
    expect_mean(render(context(), shared, setup), expected.mean, "a lamp that is none");
    // The other way round, a dark mesh shines.
    own.instances[0].material = 1;
    own.meshes[1].materials.assign(2, 0);
    shared.meshes[0].materials.assign(2, 1);
    shared.instances[1].material = 0;
    const HdrImage by_override = render(context(), own, setup), by_mesh = render(context(), shared, setup);
    EXPECT_GT(statistics(by_mesh).mean, expected.mean);
    expect_mean(by_override, statistics(by_mesh).mean, "a floor that shines");
}

// Rays are queued by kind of material: a clear one needs a kernel that passes surfaces, which the mesh's own does not.
TEST_F(MovingSceneTest, MaterialsOfTheirOwnAreOfTheirOwnKind) {
    Scene scene;
    add(scene, wide_floor(), {.name = "white", .unlit = true});
    add(scene, wide_floor(1), {.name = "black", .base_color = vec4(0), .unlit = true});
    scene.materials.push_back({.name = "clear", .base_color = vec4(0), .alpha_mode = AlphaMode::blend});
    RenderSetup setup = seen_from({0, 3, 0}, vec3(0), 0.1f);
    setup.settings.samples = 1;
    EXPECT_EQ(statistics(render(context(), scene, setup)).mean, 0);
    scene.instances[1].material = 2;
    EXPECT_EQ(statistics(render(context(), scene, setup)).mean, 1);
}

}  // namespace
}  // namespace twinray::path_tracer
