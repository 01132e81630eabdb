// SPDX-License-Identifier: MIT
#include <algorithm>

#include <gtest/gtest.h>

#include <twinray/scene.h>

#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "renderer/camera.h"
#include "renderer/lights.h"
#include "renderer/reference.h"

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
    Scene room = cornell_box_scene();
    EXPECT_GT(backward_of(frame_scene(room, 1)).z, 0.95f);
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

// All of a frame is seen at the scale of its tighter side, and more beside it.
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

TEST(LocalLights, AreChosenByTheirPower) {
    Scene scene = cornell_box_scene();
    scene.lights.push_back({.name = "light", .kind = Light::Kind::point, .color = vec3(1)});
    const LocalLights lights = collect_lights(scene);
    ASSERT_EQ(lights.emitters.size(), 2u);
    ASSERT_EQ(lights.punctual.size(), 1u);
    const double light = static_cast<double>(PI * 0.25f * luminance(vec3(15, 13.5f, 11))),
                 point = static_cast<double>(4 * PI);
    EXPECT_NEAR(lights.punctual[0].chance, point / (light + point), 1e-5);
    EXPECT_NEAR(lights.densities[lights.emitters[0].instance][0], light / (light + point) / 0.25, 1e-4);
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

}  // namespace
}  // namespace twinray::path_tracer
