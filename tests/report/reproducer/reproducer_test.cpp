// SPDX-License-Identifier: MIT
// A reproducer as it is handed out: the right answers, the program that asks for them, and the page about both.
#include <gtest/gtest.h>

#include <twinray/geometry.h>
#include "report/reproducer/reproduce.h"
#include "report/reproducer/program.h"
#include "report/reproducer/right_answers.h"
#include "tests/scene/temp_dir.h"

namespace twinray::reproducer {
namespace {

Scene scene_of(std::vector<vec3> positions, std::vector<uvec3> triangles) {
    Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    Scene scene;
    scene.meshes = {mesh};
    scene.instances = {{"", 0, Transform{}}};
    return scene;
}

// Two triangles of a square in the plane z = 0, and one behind them.
Scene square() {
    return scene_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, -1}, {1, 0, -1}, {1, 1, -1}},
                    {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}});
}

Ray down_at(float x, float y) { return {vec3(x, y, 2), 0, vec3(0, 0, -1), INFINITY}; }

RightAnswers answers_at(float x, float y) { return right_answers(ReferenceScene::of(square()), down_at(x, y)); }

Hit hit(uint primitive, float t, float u, float v) { return {1, t, primitive, 0, u, v, 0, 0}; }

TEST(RightAnswers, InsideOfATriangleThereIsOne) {
    const RightAnswers right = answers_at(0.75f, 0.25f);
    EXPECT_TRUE(right.allow(hit(0, 2, 0.5f, 0.25f)));
    EXPECT_FALSE(right.allow(miss()));
    EXPECT_FALSE(right.allow(hit(1, 2, 0.5f, 0.25f)));
    EXPECT_FALSE(right.allow(hit(2, 3, 0.5f, 0.25f))) << "behind";
    EXPECT_FALSE(right.allow(hit(0, 2.001f, 0.5f, 0.25f)));
    EXPECT_FALSE(right.allow(hit(0, 2, 0.5f, 0.2501f)));
    EXPECT_FALSE(right.allow(hit(0, 2, 0.501f, 0.25f)));
    EXPECT_FALSE(right.allow(hit(0, NAN, 0.5f, 0.25f)));
    EXPECT_FALSE(right.allow(hit(0, 2, NAN, 0.25f)));
    EXPECT_EQ(right.exact, "triangle 0 of instance 0 at t = 2, u = 1/2 = 0.5, v = 1/4 = 0.25, inside it");
}

TEST(RightAnswers, OnASharedEdgeEitherTriangleAndNoMiss) {
    const RightAnswers right = answers_at(0.5f, 0.5f);
    EXPECT_TRUE(right.allow(hit(0, 2, 0, 0.5f)));
    EXPECT_TRUE(right.allow(hit(1, 2, 0.5f, 0)));
    EXPECT_FALSE(right.allow(miss()));
    EXPECT_NE(right.exact.find("on its edge; 2 triangles meet the ray there"), std::string::npos) << right.exact;
}

TEST(RightAnswers, OnARimAMissToo) {
    const RightAnswers right = answers_at(0.25f, 1);
    EXPECT_TRUE(right.allow(hit(1, 2, 0.25f, 0.75f)));
    EXPECT_TRUE(right.allow(miss()));
}

TEST(RightAnswers, BesideAllTrianglesAMissAlone) {
    const RightAnswers right = answers_at(3, 3);
    EXPECT_TRUE(right.allow(miss()));
    EXPECT_TRUE(right.hits.empty());
    EXPECT_EQ(right.exact, "a miss");
}

TEST(Program, IsTheTemplateWithOtherData) {
    Scene scene = square();
    scene.instances.push_back({"", 0, Transform::scaling(vec3(-1, 0.1f, 1))});
    const std::string program =
        program_text({scene, down_at(0.1f, 3), answers_at(3, 3), true, "a \"quoted\" \\ device"});
    for (const std::string part :
         {"found_on[] = \"a \\\"quoted\\\" \\\\ device\"", "by_pipeline = 1", "{0, 0, -1},", "{11, 12, 13},",
          "{0, 3, {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}},",
          "{3, 3, {{{-1, 0, 0, 0}, {0, 0x1.99999ap-4f, 0, 0}, {0, 0, 1, 0}}}},",
          "ray[8] = {0x1.99999ap-4f, 3, 2, /* t_min */ 0,", "/* t_max */ INFINITY}", "is_miss_right = 1",
          "right_hit_count = 0", "query_spirv[] = {\n    0x07230203,", "// END OF DATA", "return right ? 0 : 1;"})
        EXPECT_NE(program.find(part), std::string::npos) << part << "\n" << program.substr(0, 4000);
    EXPECT_EQ(program.find("this is a template"), std::string::npos);
}

// Two triangles of a square, which a ray on their common edge misses.
Reproduction leak() {
    Reproduction found;
    found.scene = scene_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1f}}, {{0, 1, 2}, {0, 2, 3}});
    found.ray = down_at(0.5f, 0.5f);
    found.backend = frame::Backend::ray_query;
    found.kind = HitClass::hw_leak;
    found.answer = miss();
    found.right.exact = "triangle 0 of instance 0 at t = 2";
    found.triangles_before = 128;
    return found;
}

std::string page_of(const Reproduction& found) {
    replay::Replay replay;
    replay.device = "a device";
    replay.driver = "a driver 1.2";
    replay.kind = name_of(found.kind);
    return page_text(found, replay);
}

TEST(Page, TellsWhatATrackerWants) {
    const std::string page = page_of(leak());
    for (const char* part :
         {"# a device: a ray misses although it meets triangles", "driver: a driver 1.2",
          "a ray query (`VK_KHR_ray_query`)", "expected: triangle 0 of instance 0 at t = 2", "answered: a miss",
          "0x1p-1 0x1p-1 0x1p+1 0x0p+0", "| 0 | 1 | (0, 0, 0) (1, 1, 0) (0, 1, 0.100000001) |",
          "reduced from 128 triangles.", "This is a *should*", "./reproducer DEVICE pipeline"})
        test::expect_contains(page, part);
    EXPECT_EQ(page.find("winding is not equal"), std::string::npos);
    EXPECT_EQ(page.find("has the transform"), std::string::npos);
}

TEST(Page, SaysWhereVulkanPromisesNothing) {
    Reproduction turned = leak();
    std::swap(turned.scene.meshes[0].triangles[1].y, turned.scene.meshes[0].triangles[1].z);
    test::expect_contains(page_of(turned), "their winding is not equal");
    Reproduction far = leak();
    far.kind = HitClass::hw_t_err;
    far.answer = {1, 2.5f, 1, 0, 0.25f, 0.5f, 0, 0};
    far.scene.instances[0].transform = Transform::scaling(vec3(2));
    far.was_cut_short = true;
    const std::string page = page_of(far);
    for (const char* part : {"answered: triangle 1 of instance 0 at t = 2.5, u = 0.25, v = 0.5", "states no precision",
                             "Instance 0 has the transform, row by row (2, 0, 0, 0)", "it may not be the smallest"})
        test::expect_contains(page, part);
}

}  // namespace
}  // namespace twinray::reproducer
