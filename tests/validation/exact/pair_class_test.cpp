// Classes of triangles, compared with a reference in rational arithmetic that shares no code and no method with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <string>

#include "engine/collide/exact_class.h"
#include "engine/core/parallel.h"
#include "tests/collide/triangle_pairs.h"
#include "validation/exact/exact_reference.h"

namespace twinray::exact {
namespace {

// Classes of triangles by another way than the engine's: the common part of both is computed in rational numbers, by
// cutting one with the half-spaces of the other, and then looked at.
using Points = std::vector<Vector>;

bool is_zero(const Vector& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

// The points p with dot(normal, p) >= offset.
struct HalfSpace {
    Vector normal;
    Rational offset;
    Rational height(const Vector& p) const { return dot(normal, p) - offset; }
};

Vector negated(const Vector& v) { return {-v.x, -v.y, -v.z}; }

// The span of a set of points, from its first one.
struct Span {
    int dimension = 0;
    Vector direction, normal;  // of the line; of the plane

    explicit Span(const Points& points) {
        for (const Vector& p : points) add(p - points[0]);
    }
    void add(const Vector& v) {
        if (dimension == 0 && !is_zero(v)) {
            dimension = 1;
            direction = v;
        } else if (dimension == 1 && !is_zero(cross(direction, v))) {
            dimension = 2;
            normal = cross(direction, v);
        } else if (dimension == 2 && dot(normal, v) != 0) {
            dimension = 3;
        }
    }
};

// A triangle as a convex set: the point, line or plane that it lies in, and its borders there.
struct Shape {
    Points points;
    std::vector<HalfSpace> equalities;  // each with its opposite
    std::vector<HalfSpace> borders;

    explicit Shape(const WorldTriangle& t) : points{vector_of(t.a), vector_of(t.b), vector_of(t.c)} {
        const Span span(points);
        const Vector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
        if (span.dimension == 0) {
            for (const Vector& axis : {x, y, z}) equal(axis);
        } else if (span.dimension == 1) {
            for (const Vector& axis : {x, y, z})
                if (const Vector side = cross(span.direction, axis); !is_zero(side)) equal(side);
            bound(span.direction);
            bound(negated(span.direction));
        } else {
            equal(span.normal);
            for (std::size_t i = 0; i < 3; ++i) {
                const Vector inwards = cross(span.normal, points[(i + 1) % 3] - points[i]);
                borders.push_back({inwards, dot(inwards, points[i])});
            }
        }
    }
    bool has_inside(const Vector& p) const {
        return std::ranges::all_of(equalities, [&](const HalfSpace& h) { return h.height(p) == 0; }) &&
               std::ranges::all_of(borders, [&](const HalfSpace& h) { return h.height(p) > 0; });
    }
    bool has_extreme_point(const Vector& p) const {
        int borders_met = 0;
        for (const HalfSpace& h : borders) borders_met += h.height(p) == 0;
        if (borders.empty()) return true;                     // a point
        return borders_met >= (borders.size() == 2 ? 1 : 2);  // of a segment, of a triangle
    }

  private:
    void equal(const Vector& normal) {
        equalities.push_back({normal, dot(normal, points[0])});
        equalities.push_back({negated(normal), -dot(normal, points[0])});
    }
    void bound(const Vector& normal) {
        Rational least = dot(normal, points[0]);
        for (const Vector& p : points) least = std::min(least, Rational(dot(normal, p)));
        borders.push_back({normal, least});
    }
};

// Returns the part of a convex polygon within a half-space (Sutherland and Hodgman).
Points cut(const Points& polygon, const HalfSpace& by) {
    std::vector<Rational> heights;
    for (const Vector& p : polygon) heights.push_back(by.height(p));
    Points kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const std::size_t next = (i + 1) % polygon.size();
        if (heights[i] >= 0) kept.push_back(polygon[i]);
        if (sgn(heights[i]) * sgn(heights[next]) >= 0) continue;
        const Rational along = heights[i] / (heights[i] - heights[next]);
        const Vector edge = polygon[next] - polygon[i];
        kept.push_back(polygon[i] + Vector{along * edge.x, along * edge.y, along * edge.z});
    }
    return kept;
}

Points common_part(const Shape& a, const Shape& b) {
    Points part = b.points;
    for (const auto* half_spaces : {&a.equalities, &a.borders})
        for (const HalfSpace& half_space : *half_spaces) {
            part = cut(part, half_space);
            if (part.empty()) return part;
        }
    return part;
}

Vector middle_of(const Points& points) {
    Vector sum{0, 0, 0};
    for (const Vector& p : points) sum = sum + p;
    const Rational n(static_cast<int>(points.size()));
    return {sum.x / n, sum.y / n, sum.z / n};
}

// Returns the extreme points, in no order and maybe more than once.
Points common_part(const WorldTriangle& a, const WorldTriangle& b) { return common_part(Shape(a), Shape(b)); }

PairClass exact_pair_class(const WorldTriangle& a, const WorldTriangle& b) {
    const Shape of_a(a), of_b(b);
    const Points part = common_part(of_a, of_b);
    if (part.empty()) return PairClass::separate;
    const int dimension = Span(part).dimension;
    Points vertices = of_a.points;
    vertices.insert(vertices.end(), of_b.points.begin(), of_b.points.end());
    if (Span(vertices).dimension < 3) return dimension == 2 ? PairClass::coplanar_overlap : PairClass::coplanar_touch;
    const Vector middle = middle_of(part);  // inside of the common part
    if (of_a.has_inside(middle) && of_b.has_inside(middle)) return PairClass::crossing;
    const bool is_vertex = of_a.has_extreme_point(middle) || of_b.has_extreme_point(middle);
    return dimension == 0 && is_vertex ? PairClass::vertex_touch : PairClass::edge_touch;
}

using test::triangle_of;
using enum PairClass;

const WorldTriangle floor_triangle = triangle_of({0, 0, 0}, {4, 0, 0}, {0, 4, 0});

// Expects this class for every order of vertices and triangles, and from the reference.
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
    // The plane is x - 2 y + z = 0, so that nothing is along an axis.
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

// The tip of one triangle floats k steps above, on or below the face of another, far from the origin too.
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

// One vertex of each is put on the other as well as float64 can, so it is nearly never on it.
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
