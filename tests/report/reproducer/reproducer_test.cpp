// The search for a fault's least case, and its reproducer as it is handed out: the right answers, the program that asks
// for them, and the page about both.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <twinray/geometry.h>

#include "report/reproducer/program.h"
#include "report/reproducer/reproduce.h"
#include "report/reproducer/simplify.h"
#include "tests/scene/temp_dir.h"

namespace twinray::reproducer {
namespace {

// Shows a fault if all of `needed` are there, and counts questions.
struct Needs {
    Indices needed;
    std::size_t questions = 0;

    bool operator()(const Indices& kept) {
        ++questions;
        EXPECT_TRUE(std::ranges::is_sorted(kept));
        return std::ranges::includes(kept, needed);
    }
};

Indices reduced(std::size_t count, Needs& needs) {
    return ddmin(count, [&](const Indices& kept) { return needs(kept); });
}

TEST(Ddmin, FindsExactlyWhatIsNeeded) {
    for (const Indices& needed : {Indices{0}, Indices{99}, Indices{37}, Indices{0, 99}, Indices{3, 4, 5, 50, 51, 98}}) {
        Needs needs{needed};
        EXPECT_EQ(reduced(100, needs), needed);
    }
}

TEST(Ddmin, OneOfManyTakesTwoQuestionsAHalving) {
    for (const std::size_t where : {0u, 12345u, 65535u}) {
        Needs needs{{where}};
        EXPECT_EQ(reduced(65536, needs), Indices{where});
        EXPECT_LE(needs.questions, 2u * 16u);
    }
}

TEST(Ddmin, TheWorstCaseKeepsToItsBound) {
    Needs needs{Indices(64)};
    std::iota(needs.needed.begin(), needs.needed.end(), 0u);
    EXPECT_EQ(reduced(64, needs).size(), 64u);
    EXPECT_LE(needs.questions, 64u * 64u + 3u * 64u);
}

TEST(Ddmin, NothingCanBeLeftOutOfWhatComesBack) {
    // The fault is not monotonic and has several least answers: an even number of indices, one of which is 3 modulo 7.
    const auto shows_fault = [](const Indices& kept) {
        return kept.size() % 2 == 0 && std::ranges::any_of(kept, [](std::size_t i) { return i % 7 == 3; });
    };
    const Indices kept = ddmin(90, shows_fault);
    ASSERT_TRUE(shows_fault(kept));
    for (std::size_t left_out = 0; left_out < kept.size(); ++left_out) {
        Indices fewer = kept;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(left_out));
        EXPECT_FALSE(shows_fault(fewer));
    }
    EXPECT_EQ(ddmin(90, shows_fault), kept);
}

TEST(Ddmin, OneOrNoneIsLeftAsItIs) {
    Needs needs{{}};
    EXPECT_EQ(reduced(1, needs), Indices{0});
    EXPECT_EQ(reduced(0, needs), Indices{});
    EXPECT_EQ(needs.questions, 0u);
}

TEST(ShortNumbers, LengthOrdersThemAsAReaderWould) {
    EXPECT_EQ(length_of(0), 0);
    EXPECT_EQ(length_of(INFINITY), 0);
    EXPECT_LT(length_of(0), length_of(1));
    EXPECT_EQ(length_of(1), length_of(2));
    EXPECT_LT(length_of(1), length_of(-1));
    EXPECT_LT(length_of(4), length_of(3));
    EXPECT_LT(length_of(3), length_of(0.1f));
    EXPECT_LT(length_of(1), length_of(0x1p-60f));
}

TEST(ShortNumbers, AreShorterTheShortestFirstAndNear) {
    for (const float value : {0.1f, -7.3f, 123456.7f, 1e-30f, -3e38f, std::numeric_limits<float>::denorm_min() * 5}) {
        const std::vector<float> shorter = shorter_numbers(value);
        ASSERT_FALSE(shorter.empty()) << value;
        EXPECT_EQ(shorter.front(), 0);
        EXPECT_TRUE(std::ranges::is_sorted(shorter, {}, length_of)) << value;
        for (const float candidate : shorter) {
            EXPECT_TRUE(std::isfinite(candidate)) << value;
            EXPECT_LT(length_of(candidate), length_of(value)) << value << " -> " << candidate;
        }
        // The nearest of them has nearly as many bits, except among denormals, which have few bits.
        const auto nearest = std::ranges::min(shorter, {}, [&](float c) { return std::abs(c - value); });
        const bool is_denormal = std::abs(value) < std::numeric_limits<float>::min();
        EXPECT_TRUE(is_denormal || std::abs(nearest - value) <= std::abs(value) * 0x1p-18f) << value;
    }
    EXPECT_EQ(shorter_numbers(3.0009f)[1], 4);
    EXPECT_EQ(std::ranges::count(shorter_numbers(3.0009f), 3), 1);
}

TEST(ShortNumbers, NothingIsShorterThanZeroAndNoEnd) {
    EXPECT_TRUE(shorter_numbers(0).empty());
    EXPECT_TRUE(shorter_numbers(INFINITY).empty());
    EXPECT_TRUE(shorter_numbers(NAN).empty());
    EXPECT_EQ(shorter_numbers(1), std::vector<float>{0});
}

Scene grids(std::size_t instances) {
    Scene scene;
    scene.meshes = {make_grid(6, 6)};
    for (std::size_t i = 0; i < instances; ++i)
        scene.instances.push_back({"", 0, Transform::translation(vec3(0.1f, static_cast<float>(i), 0.3f))});
    return scene;
}

const Ray some_ray{vec3(0.123f, 9.7f, 0.377f), 0.1f, vec3(0.001f, -0.998f, 0.003f), 55.5f};

bool spans(const CaseTriangle& triangle, const FaultCase& fault, const vec3& point) {
    Bounds box;
    for (const vec3& vertex : triangle.vertices)
        box.include(transform_point(fault.transforms[triangle.instance], vertex));
    return box.lo.x <= point.x && point.x <= box.hi.x && box.lo.y <= point.y && point.y <= box.hi.y &&
           box.lo.z <= point.z && point.z <= box.hi.z;
}

// Returns whether there are three or more triangles at this vertex and each edge from it belongs to two of them.
bool closes_around(const FaultCase& fault, const vec3& hub) {
    std::vector<vec3> rim;
    for (const CaseTriangle& t : fault.triangles)
        if (std::ranges::count(t.vertices, hub) == 1)
            std::ranges::copy_if(t.vertices, std::back_inserter(rim), [&](const vec3& v) { return v != hub; });
    return rim.size() >= 6 && std::ranges::all_of(rim, [&](const vec3& v) { return std::ranges::count(rim, v) == 2; });
}

TEST(FaultCase, IsTheSceneThatItWasMadeOf) {
    const Scene scene = grids(2);
    for (const bool reorders : {false, true}) {
        const FaultCase fault = case_of(scene, some_ray, reorders);
        EXPECT_EQ(fault.triangles.size(), 2 * scene.meshes[0].triangles.size());
        const Scene again = scene_of(fault);
        ASSERT_EQ(again.instances.size(), 2u);
        EXPECT_EQ(again.instances[1].transform, scene.instances[1].transform);
        EXPECT_EQ(again.meshes[1].positions.size(), scene.meshes[0].positions.size()) << "vertices are shared";
        EXPECT_EQ(count_triangles(again), count_triangles(scene));
    }
}

TEST(FaultCase, NearTheRayIsWhatItMeetsAndTheTriangleAskedFor) {
    const FaultCase fault = case_of(grids(3), some_ray, false);
    const FaultCase near = near_the_ray(fault, 2, 71);
    EXPECT_LT(near.triangles.size(), fault.triangles.size() / 4);
    EXPECT_EQ(near.triangles.back(), fault.triangles.back()) << "the last one was asked for";
    for (const CaseTriangle& triangle : fault.triangles) {
        const float height = transform_point(fault.transforms[triangle.instance], vec3(0)).y;
        const bool is_met = spans(triangle, fault, {0.123f, height, 0.377f});
        EXPECT_TRUE(!is_met || std::ranges::count(near.triangles, triangle) == 1);
    }
}

TEST(FaultCase, AsBuiltIsTheSameWorldInOtherUnits) {
    FaultCase fault = case_of(grids(2), some_ray, false);
    for (CaseTriangle& triangle : fault.triangles)
        for (vec3& vertex : triangle.vertices) vertex *= triangle.instance == 0 ? 24.0f : 1.0f;
    const FaultCase built = as_built(fault);
    EXPECT_EQ(built.transforms[0].rows[0], vec4(16, 0, 0, 0.1f));
    EXPECT_EQ(built.transforms[1], fault.transforms[1]);
    for (std::size_t i = 0; i < fault.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const CaseTriangle &a = built.triangles[i], &b = fault.triangles[i];
            EXPECT_EQ(transform_point(built.transforms[a.instance], a.vertices[k]),
                      transform_point(fault.transforms[b.instance], b.vertices[k]));
        }
    EXPECT_EQ(as_built(built).triangles, built.triangles);
}

TEST(Simplify, KeepsWhatTheFaultNeedsInTheWorldAndAlone) {
    // The fault needs some triangle over the point.
    const auto shows_fault = [](const FaultCase& fault) {
        return std::ranges::any_of(fault.triangles, [&](const CaseTriangle& triangle) {
            return spans(triangle, fault, {0.5f, 1, 0.7f});
        });
    };
    const FaultCase least = simplified(case_of(grids(3), some_ray, false), shows_fault);
    ASSERT_TRUE(shows_fault(least));
    EXPECT_EQ(least.triangles.size(), 1u);
    EXPECT_EQ(least.transforms[least.triangles[0].instance], Transform{});
    EXPECT_EQ(least.ray.t_min, 0);
    EXPECT_EQ(least.ray.t_max, std::numeric_limits<float>::infinity());
    EXPECT_EQ(least.ray.direction, vec3(0));
    EXPECT_EQ(least.ray.origin, vec3(0));
    for (const vec3& vertex : least.triangles[0].vertices) EXPECT_EQ(2.0f * vertex, round(2.0f * vertex));
}

TEST(Simplify, JoinsTheSixTrianglesAroundAVertexToThree) {
    const vec3 hub(0.5f, 0, 0.5f);
    const auto closes = [&](const FaultCase& fault) { return closes_around(fault, hub); };
    Scene scene = grids(1);
    scene.instances[0].transform = {};
    FaultCase fault = case_of(scene, some_ray, false);
    ASSERT_TRUE(closes(fault));
    leave_out_triangles(fault, closes);
    EXPECT_EQ(fault.triangles.size(), 6u);
    EXPECT_TRUE(join_vertices(fault, closes));
    EXPECT_EQ(fault.triangles.size(), 3u);
    EXPECT_TRUE(closes(fault));
}

TEST(Simplify, AFanOfAThousandTrianglesTakesFewQuestions) {
    // The fan is closed around the origin.
    FaultCase fault{{Transform{}}, {}, some_ray};
    const auto rim = [](int i) {
        const float angle = 6.2831853f * static_cast<float>(i % 1000) / 1000;
        return vec3(std::cos(angle), 0, std::sin(angle));
    };
    for (int i = 0; i < 1000; ++i) fault.triangles.push_back({0, {vec3(0), rim(i), rim(i + 1)}});
    std::size_t questions = 0;
    const auto closes = [&](const FaultCase& smaller) {
        ++questions;
        return closes_around(smaller, vec3(0));
    };
    ASSERT_TRUE(closes(fault));
    EXPECT_EQ(simplified(fault, closes).triangles.size(), 3u);
    EXPECT_LT(questions, 1000u);
}

TEST(Simplify, WhatCannotBeChangedStaysAndEveryRunIsAlike) {
    const FaultCase fault = case_of(grids(2), some_ray, false);
    std::size_t questions = 0;
    const auto same = [&](const FaultCase& other) {
        ++questions;
        return other.triangles == fault.triangles && other.transforms == fault.transforms &&
               other.ray.origin == fault.ray.origin && other.ray.direction == fault.ray.direction &&
               other.ray.t_max == fault.ray.t_max;
    };
    EXPECT_EQ(simplified(fault, same).triangles, fault.triangles);
    const std::size_t first = std::exchange(questions, 0);
    EXPECT_EQ(simplified(fault, same).triangles, fault.triangles);
    EXPECT_EQ(questions, first);
}

Scene scene_of(std::vector<vec3> positions, std::vector<uvec3> triangles) {
    Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].positions = std::move(positions);
    scene.meshes[0].triangles = std::move(triangles);
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
        test::expect_contains(program, part);
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
