// SPDX-License-Identifier: MIT
#include "report/reproducer/right_answers.h"

#include <gtest/gtest.h>

#include <twinray/geometry.h>
#include "report/reproducer/program.h"

namespace twinray::reproducer {
namespace {

// Two triangles of a square in the plane z = 0, and one behind them.
Scene square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, -1}, {1, 0, -1}, {1, 1, -1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
    Scene scene;
    scene.meshes = {mesh};
    scene.instances = {{"", 0, Transform{}}};
    return scene;
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

}  // namespace
}  // namespace twinray::reproducer
