// SPDX-License-Identifier: MIT
// Classes of triangles against a reference in rational arithmetic that shares no code and no method with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <string>

#include "engine/collide/exact_class.h"
#include "engine/core/parallel.h"
#include "tests/collide/triangle_pairs.h"
#include "tests/validation/exact/pair_reference.h"

namespace twinray::exact {
namespace {

using test::triangle_of;
using enum PairClass;

const WorldTriangle floor_triangle = triangle_of({0, 0, 0}, {4, 0, 0}, {0, 4, 0});

// In every order of vertices and triangles, and by the reference.
void expect_class(const WorldTriangle& a, const WorldTriangle& b, PairClass expected, const char* what) {
    EXPECT_EQ(name_of(exact_pair_class(a, b)), name_of(expected)) << what << ", reference";
    EXPECT_EQ(name_of(exact_pair_class(b, a)), name_of(expected)) << what << ", reference";
    for (const WorldTriangle& pa : test::permutations(a))
        for (const WorldTriangle& pb : test::permutations(b)) {
            EXPECT_EQ(name_of(exact_class(pa, pb)), name_of(expected)) << what;
            EXPECT_EQ(name_of(exact_class(pb, pa)), name_of(expected)) << what;
        }
}

TEST(PairClassTest, Touches) {
    const auto expect = [](const char* what, const WorldTriangle& other, PairClass expected) {
        expect_class(floor_triangle, other, expected, what);
    };
    expect("vertex on vertex", triangle_of({0, 0, 0}, {-1, 0, 1}, {0, -1, 1}), vertex_touch);
    expect("vertex on edge", triangle_of({2, 0, 0}, {2, -1, 1}, {3, -1, 2}), vertex_touch);
    expect("vertex on face", triangle_of({1, 1, 0}, {1, 1, 2}, {2, 1, 2}), vertex_touch);
    expect("face on vertex", triangle_of({-1, -1, 1}, {-1, -1, -1}, {2, 2, 0}), crossing);
    expect("vertex behind an edge that crosses", triangle_of({0, 4, 0}, {1, -1, -1}, {1, -1, 1}), crossing);
    expect("edge on edge", triangle_of({2, -1, -1}, {2, 1, 1}, {2, -3, 3}), edge_touch);
    expect("edge in edge", triangle_of({1, 0, 0}, {3, 0, 0}, {2, -1, 1}), edge_touch);
    expect("edge beyond edge", triangle_of({3, 0, 0}, {9, 0, 0}, {5, -1, 1}), edge_touch);
    expect("edge after edge", triangle_of({4, 0, 0}, {9, 0, 0}, {5, -1, 1}), vertex_touch);
    expect("edge in face", triangle_of({1, 1, 0}, {2, 1, 0}, {1, 1, 1}), edge_touch);
    expect("edge through face and beyond", triangle_of({-1, 1, 0}, {9, 1, 0}, {1, 1, 1}), edge_touch);
    expect("through the face", triangle_of({1, 1, -1}, {1, 1, 1}, {2, 1, 1}), crossing);
    expect("through an edge", triangle_of({2, -1, -1}, {2, 1, 1}, {2, 1, -1}), crossing);
    expect("beside", triangle_of({5, 5, -1}, {5, 5, 1}, {6, 5, 1}), separate);
    expect("above", triangle_of({0, 0, 1}, {4, 0, 1}, {0, 4, 2}), separate);
}

TEST(PairClassTest, OfOnePlane) {
    // x - 2 y + z = 0, so that nothing is along an axis.
    const auto raised = [](double x, double y) { return dvec3(x, y, 2 * y - x); };
    const WorldTriangle base = triangle_of(raised(0, 0), raised(4, 0), raised(0, 4));
    const auto expect = [&](const char* what, dvec2 a, dvec2 b, dvec2 c, PairClass expected) {
        expect_class(base, triangle_of(raised(a.x, a.y), raised(b.x, b.y), raised(c.x, c.y)), expected, what);
    };
    expect("itself", {0, 0}, {4, 0}, {0, 4}, coplanar_overlap);
    expect("inside", {1, 1}, {2, 1}, {1, 2}, coplanar_overlap);
    expect("around", {-9, -9}, {30, -9}, {-9, 30}, coplanar_overlap);
    expect("star", {2, 3}, {-1, 1}, {3, -1}, coplanar_overlap);
    expect("a side in common, on one side", {0, 0}, {4, 0}, {9, 9}, coplanar_overlap);
    expect("a side in common, on two sides", {0, 0}, {4, 0}, {2, -3}, coplanar_touch);
    expect("a vertex in common", {4, 0}, {6, 1}, {6, -1}, coplanar_touch);
    expect("a vertex on a side", {2, 2}, {5, 2}, {5, 5}, coplanar_touch);
    expect("sides on one line, apart", {5, 0}, {6, 0}, {5, -2}, separate);
    expect("apart", {3, 3}, {5, 3}, {5, 5}, separate);
}

TEST(PairClassTest, TrianglesWithoutAreaAreSegmentsAndPoints) {
    const auto segment = [](dvec3 a, dvec3 b) { return triangle_of(a, 0.5 * (a + b), b); };
    const auto point = [](dvec3 a) { return triangle_of(a, a, a); };
    const auto expect = [](const char* what, const WorldTriangle& a, const WorldTriangle& b, PairClass expected) {
        expect_class(a, b, expected, what);
    };
    expect("segment through face", floor_triangle, segment({1, 1, -1}, {1, 1, 1}), crossing);
    expect("segment through edge", floor_triangle, segment({2, 0, -1}, {2, 0, 1}), edge_touch);
    expect("segment through vertex", floor_triangle, segment({4, 0, -1}, {4, 0, 1}), vertex_touch);
    expect("segment onto face", floor_triangle, segment({1, 1, 0}, {1, 1, 1}), vertex_touch);
    expect("segment beside", floor_triangle, segment({3, 3, -1}, {3, 3, 1}), separate);
    expect("segment in face", floor_triangle, segment({1, 1, 0}, {9, 1, 0}), coplanar_touch);
    expect("segment in plane, apart", floor_triangle, segment({5, 1, 0}, {9, 1, 0}), separate);
    expect("point in face", floor_triangle, point({1, 1, 0}), coplanar_touch);
    expect("point above", floor_triangle, point({1, 1, 1}), separate);
    expect("point in plane, apart", floor_triangle, point({3, 3, 0}), separate);
    expect("segments that cross", segment({0, 0, 0}, {2, 2, 2}), segment({2, 0, 0}, {0, 2, 2}), coplanar_touch);
    expect("segments that pass", segment({0, 0, 0}, {2, 2, 2}), segment({2, 0, 0}, {0, 2, 4}), separate);
    expect("segments on a line", segment({0, 0, 0}, {2, 2, 2}), segment({1, 1, 1}, {4, 4, 4}), coplanar_touch);
    expect("segments on a line, apart", segment({0, 0, 0}, {2, 2, 2}), segment({3, 3, 3}, {4, 4, 4}), separate);
    expect("parallel segments", segment({0, 0, 0}, {2, 2, 2}), segment({0, 0, 1}, {2, 2, 3}), separate);
    expect("point in segment", segment({0, 0, 0}, {2, 2, 2}), point({1, 1, 1}), coplanar_touch);
    expect("point behind segment", segment({0, 0, 0}, {2, 2, 2}), point({3, 3, 3}), separate);
    expect("point beside segment", segment({0, 0, 0}, {2, 2, 2}), point({1, 1, 2}), separate);
    expect("points", point({1, 2, 3}), point({1, 2, 3}), coplanar_touch);
    expect("two points", point({1, 2, 3}), point({1, 2, 4}), separate);
}

// The tip of one triangle k floats above, on or below the face of another, far from the origin too.
TEST(PairClassTest, GapsOfFewUlps) {
    for (const float height : {0.0f, 1.0f, 1e3f, 1e6f}) {
        float above = height, below = height;
        for (int k = 0; k <= 4; ++k) {
            const dvec3 at(height);
            const WorldTriangle face = triangle_of(at, at + dvec3(4, 0, 0), at + dvec3(0, 4, 0));
            const auto tip = [&](float z) {
                return triangle_of({at.x + 1, at.y + 1, z}, at + dvec3(1, 1, 9), at + dvec3(2, 1, 9));
            };
            expect_class(face, tip(above), k ? separate : vertex_touch, "above");
            expect_class(face, tip(below), k ? crossing : vertex_touch, "below");
            above = std::nextafter(above, INFINITY);
            below = std::nextafter(below, -INFINITY);
        }
    }
}

TEST(PairClassTest, TinyGapsAndSlivers) {
    for (const double gap : {1e-7, 1e-15, 1e-30}) {
        expect_class(floor_triangle, triangle_of({1, 1, gap}, {1, 1, 2}, {2, 1, 2}), separate, "gap");
        expect_class(floor_triangle, triangle_of({1, 1, -gap}, {1, 1, 2}, {2, 1, 2}), crossing, "no gap");
        expect_class(floor_triangle, triangle_of({-gap, 0, 0}, {-1, 0, 1}, {-1, 1, 1}), separate, "beside");
    }
    // Planes at an angle of 1e-8.
    const WorldTriangle sliver = triangle_of({-1, -1e-8, -1e-16}, {1, -1e-8, -1e-16}, {0, 1e-8, 1e-16});
    expect_class(sliver, triangle_of({-2, -1, 0}, {2, -1, 0}, {0, 3, 0}), crossing, "sliver");
    expect_class(triangle_of({0.1, 0.7, 0.3}, {0.9, 0.2, 0.6}, {0.4, 0.4, 0.8}),
                 triangle_of({0.1, 0.7, 0.3}, {0.9, 0.2, 0.6}, {0.4, 0.4, 0.8 + 1e-8}), edge_touch, "shared edge");
}

TEST(PairClassTest, OnALattice) {
    const std::vector<TrianglePair> pairs = test::lattice_pairs(test::lattice_count(), 5);
    std::array<std::atomic<std::size_t>, PAIR_CLASSES> counts{};
    std::atomic<std::size_t> wrong{0};
    parallel_for(pairs.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const PairClass expected = exact_pair_class(pairs[i].a, pairs[i].b);
            wrong += exact_class(pairs[i].a, pairs[i].b) != expected;
            ++counts[static_cast<std::size_t>(expected)];
        }
    });
    EXPECT_EQ(wrong, 0u);
    for (const PairClass each : all_pair_classes) {
        const std::size_t count = counts[static_cast<std::size_t>(each)];
        std::printf("%s %zu\n", std::string(name_of(each)).c_str(), count);
        EXPECT_GT(count, pairs.size() / 100) << name_of(each);
    }
}

double coordinate(std::mt19937_64& random) { return std::ldexp(static_cast<double>(random() >> 11), -52) - 1; }
dvec3 point_in_cube(std::mt19937_64& random) {
    const double x = coordinate(random), y = coordinate(random);
    return {x, y, coordinate(random)};
}

// One vertex of each is put on the other as well as float64 can, which is nearly never on it.
TEST(PairClassTest, NearlyTouching) {
    std::mt19937_64 random(6);
    std::size_t counts[PAIR_CLASSES] = {};
    for (int i = 0; i < 8'000; ++i) {
        const double scale = std::ldexp(1.0, static_cast<int>(random() % 100) - 50);
        const auto point = [&] { return scale * point_in_cube(random); };
        const WorldTriangle a{point(), point(), point()};
        const double s = 0.5 * coordinate(random) + 0.5, t = (1 - s) * (0.5 * coordinate(random) + 0.5);
        const dvec3 on_a = a.a + s * (a.b - a.a) + (i % 2 ? t * (a.c - a.a) : dvec3(0));
        const WorldTriangle b{on_a, point(), i % 3 ? point() : a.c};
        const PairClass expected = exact_pair_class(a, b);
        ASSERT_EQ(name_of(exact_class(a, b)), name_of(expected)) << i;
        ++counts[static_cast<std::size_t>(expected)];
    }
    EXPECT_GT(counts[PAIR_SEPARATE], 500u);
    EXPECT_GT(counts[PAIR_CROSSING], 500u);
}

double largest_distance(const dvec3& a, const Vector& b) {
    const Vector d = vector_of(a) - b;
    return std::max({std::abs(d.x.get_d()), std::abs(d.y.get_d()), std::abs(d.z.get_d())});
}

TEST(ContactSegmentTest, EndsAreWhereTheCommonPartEnds) {
    std::mt19937_64 random(7);
    double worst = 0;
    int crossings = 0;
    for (int i = 0; i < 3'000; ++i) {
        const WorldTriangle a{point_in_cube(random), point_in_cube(random), point_in_cube(random)};
        const double tilt = std::ldexp(1.0, -static_cast<int>(random() % 40));  // planes nearly the same
        const auto near = [&](const dvec3& p) { return p + tilt * point_in_cube(random); };
        WorldTriangle b{near(a.a), near(a.b), near(a.c)};
        if (i % 8 == 0) b.c = b.a + 0.25 * (b.b - b.a);
        if (exact_class(a, b) != crossing) continue;
        ++crossings;
        const ContactSegment found = crossing_segment(a, b);
        for (const Vector& end : common_part(a, b))
            worst = std::max(worst, std::min(largest_distance(found.from, end), largest_distance(found.to, end)));
        for (const dvec3& mine : {found.from, found.to}) {
            double nearest = INFINITY;
            for (const Vector& end : common_part(a, b)) nearest = std::min(nearest, largest_distance(mine, end));
            worst = std::max(worst, nearest);
        }
    }
    EXPECT_GT(crossings, 1000);
    EXPECT_LT(worst, 0x1p-49 * 2);  // coordinates below 2
    std::printf("%d crossings, ends off by %.2g of 2^-49\n", crossings, worst / 0x1p-49 / 2);
}

}  // namespace
}  // namespace twinray::exact
