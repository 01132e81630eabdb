// SPDX-License-Identifier: MIT
#include <twinray/scene.h>

#include <twinray/geometry.h>
#include "tests/scene/temp_dir.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

Scene boxes() {
    Scene scene;
    scene.meshes.push_back(make_box({3, -1, 5}, {9, 1, 6}));
    scene.instances = {{"one", 0, {}}, {"two", 0, Transform::translation({40, 2, -7})}};
    return scene;
}

void expect_near(vec3 a, vec3 b, float error) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], error) << i;
}

TEST(View, FramesAreFilledFromAnyDirection) {
    const Scene scene = boxes();
    for (const vec3 direction : {vec3(0, -1, 0), vec3(0, 2, 0), vec3(-1, -0.2f, 0.3f), vec3(0, 0, 1e-30f)})
        for (const float aspect : {0.5f, 1.0f, 3.0f}) {
            const ImagePlane plane = image_plane(frame_scene(scene, aspect, direction), aspect);
            vec2 low(INFINITY), high(-INFINITY);
            for (const Instance& instance : scene.instances)
                for (const vec3& corner : scene.meshes[0].positions) {
                    const auto seen = project(plane, transform_point(instance.transform, corner));
                    ASSERT_TRUE(seen);
                    low = min(low, seen->point), high = max(high, seen->point);
                }
            const float edge = 1 / 1.04f;
            EXPECT_NEAR(std::max(high.x, high.y), edge, 0.01f) << aspect;
            EXPECT_NEAR(std::min(low.x, low.y), -edge, 0.01f) << aspect;
            expect_near(plane.forward, normalize(direction * (direction.z == 1e-30f ? 1e30f : 1.0f)), 1e-6f);
        }
}

TEST(View, LooksDownWithMinusZAtTheTop) {
    const ImagePlane plane = image_plane(frame_scene(boxes(), 1, vec3(0, -1, 0)), 1);
    expect_near(normalize(plane.up), vec3(0, 0, -1), 1e-6f);
    expect_near(normalize(plane.right), vec3(1, 0, 0), 1e-6f);
}

TEST(View, AnEmptySceneHasACamera) {
    const ImagePlane plane = image_plane(frame_scene({}, 1), 1);
    EXPECT_NEAR(length(plane.forward), 1, 1e-6f);
    EXPECT_EQ(plane.origin, vec3(0));
}

TEST(View, RefusesNoDirection) {
    expect_contains(error_of([] { frame_scene({}, 1, vec3(0)); }), "view direction (0, 0, 0) must be finite and not 0");
    expect_contains(error_of([] { frame_scene({}, 1, vec3(NAN, 0, 1)); }), "must be finite");
}

TEST(View, ProjectionsAreWhereRaysGo) {
    Camera camera = frame_scene(boxes(), 1.5f, vec3(-1, -2, -3));
    for (const bool is_orthographic : {false, true}) {
        if (is_orthographic) camera.orthographic_half_height = 4.0f;
        const ImagePlane plane = image_plane(camera, 1.5f);
        for (const vec2 at : {vec2(0), vec2(0.5f, -0.25f), vec2(-1, 1)}) {
            const Ray ray = ray_through(plane, at);
            const std::optional<Projected> seen = project(plane, ray.origin + 7.0f * ray.direction);
            ASSERT_TRUE(seen);
            EXPECT_NEAR(seen->point.x, at.x, 1e-5f);
            EXPECT_NEAR(seen->point.y, at.y, 1e-5f);
            EXPECT_NEAR(seen->depth, 7, 1e-4f);
        }
        EXPECT_FALSE(project(plane, plane.origin - plane.forward));
    }
}

}  // namespace
}  // namespace twinray::test
