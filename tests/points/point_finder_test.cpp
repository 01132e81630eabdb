// SPDX-License-Identifier: MIT
// What is near to points, by the GPU, against all triangles one by one.
#include "engine/points/point_finder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/core/parallel.h"
#include "tests/accel/accel_fixture.h"
#include "tests/points/point_reference.h"
#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

using test::PlacedTriangle;
using test::Soup;

class PointFinderTest : public test::VulkanTest {
  protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        if (!context().facts().shader_float64) GTEST_SKIP() << "no float64";
        finder_ = std::make_unique<PointFinder>(context());
    }
    void TearDown() override {
        finder_.reset();
        VulkanTest::TearDown();
    }
    PointFinder& finder() { return *finder_; }
    void set(const std::vector<MeshView>& meshes, const std::vector<MeshInstance>& instances) {
        finder_->set(meshes, instances);
        placed_ = test::placed_triangles(meshes, instances);
        sides_.clear();
        for (const PlacedTriangle& each : placed_) sides_.push_back(side_of(each.corners));
    }
    void set(const MeshView& mesh) { set({mesh}, {{0, {}}}); }
    const std::vector<PlacedTriangle>& placed() const { return placed_; }

    // The largest error of closest() in units of the last place of a double and of a float, where distances are told
    // to a double of the size of what they are computed from. Fails where another triangle is nearer.
    struct Errors {
        double of_double = 0, of_float = 0;
    };
    Errors errors_of(std::span<const dvec3> points) {
        const std::vector<ClosestPoint> found = finder().closest(points);
        std::vector<Errors> errors(points.size());
        std::vector<std::size_t> wrong(points.size(), 0);
        parallel_for(points.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                errors[i] = error_of(points[i], found[i]);
                wrong[i] = !std::isfinite(errors[i].of_double);
            }
        });
        EXPECT_EQ(std::count(wrong.begin(), wrong.end(), 1u), 0);
        Errors largest;
        for (const Errors& each : errors) {
            largest.of_double = std::max(largest.of_double, each.of_double);
            largest.of_float = std::max(largest.of_float, each.of_float);
        }
        return largest;
    }

  private:
    Errors error_of(const dvec3& point, const ClosestPoint& found) const {
        const auto is_found = [&](const PlacedTriangle& each) {
            return each.instance == found.instance && each.triangle == found.triangle;
        };
        const auto own = std::find_if(placed_.begin(), placed_.end(), is_found);
        if (own == placed_.end()) return {INFINITY, INFINITY};
        const long double of_named = test::distance(point, own->corners);
        long double least = of_named;
        double size = side_of(own->corners);
        for (std::size_t i = 0; i < placed_.size(); ++i) {
            const Corners64& corners = placed_[i].corners;
            const double to_corner = distance(point, corners.a);
            if (to_corner - sides_[i] > static_cast<double>(least) + 1e-9 * to_corner) continue;
            const long double distance = test::distance(point, corners);
            if (distance < least) {
                least = distance;
                size = sides_[i];
            }
        }
        const auto reached = static_cast<long double>(distance(found.position, point));
        const double unit = std::max({static_cast<double>(least), size, length(point)}) * 0x1p-52;
        const Corners64& t = own->corners;
        const dvec3 by_uv = (1 - found.uv.x - found.uv.y) * t.a + found.uv.x * t.b + found.uv.y * t.c;
        const long double error =
            std::max({std::abs(found.distance - least), std::abs(reached - least), of_named - least,
                      static_cast<long double>(distance(by_uv, found.position)) / 4});
        const auto as_float = static_cast<float>(least);
        return {static_cast<double>(error) / unit,
                std::abs(static_cast<double>(static_cast<float>(found.distance)) - as_float) /
                    (std::nextafter(as_float, INFINITY) - as_float)};
    }
    static double side_of(const Corners64& t) {
        return std::max({distance(t.a, t.b), distance(t.b, t.c), distance(t.c, t.a)});
    }

    std::unique_ptr<PointFinder> finder_;
    std::vector<PlacedTriangle> placed_;
    std::vector<double> sides_;  // the longest of each
};

std::vector<dvec3> random_points(std::size_t count, float size, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<dvec3> points(count);
    for (dvec3& point : points) point = dvec3(test::uniform3(random, -size, size));
    return points;
}

// TWINRAY_POINTS, or as many as take a second.
std::size_t point_count() {
    const char* asked = std::getenv("TWINRAY_POINTS");
    return asked ? std::stoul(asked) : 2'000;
}

Transform turned(std::mt19937& random, float spread) {
    Transform m = Transform::scaling(vec3(test::uniform(random, 0.5f, 1.5f)));
    for (vec4& row : m.rows) row += vec4(test::uniform3(random, -0.5f, 0.5f), test::uniform(random, -spread, spread));
    return m;
}

// Of every shape: without area, without length, needles.
Soup mixed_soup(std::size_t count, unsigned seed) {
    Soup soup = test::random_soup(count, 0.3f, seed);
    for (std::size_t i = 0; i < count; ++i) {
        vec3* corners = &soup.positions[3 * i];
        if (i % 7 == 1) corners[1] = corners[0];
        if (i % 7 == 2) corners[1] = corners[2] = corners[0];
        if (i % 7 == 3) corners[2] = corners[0] + (corners[1] - corners[0]) * 0.75f;
        if (i % 7 == 4) corners[2] = corners[1] + (corners[2] - corners[1]) * 0x1p-20f;
    }
    return soup;
}

TEST_F(PointFinderTest, TheNearestTriangleIsFoundWhateverItsShape) {
    const Soup soup = mixed_soup(300, 5);
    const Mesh ball = make_icosphere(2, 0.7f);
    std::mt19937 random(3);
    set({soup.view(), ball}, {{0, {}}, {1, turned(random, 2)}, {0, turned(random, 2)}});
    const Errors errors = errors_of(random_points(point_count(), 3, 8));
    RecordProperty("double_ulp", std::to_string(errors.of_double));
    RecordProperty("float_ulp", std::to_string(errors.of_float));
    std::cout << "largest error: " << errors.of_double << " ulp of float64, " << errors.of_float << " of float32\n";
    EXPECT_LE(errors.of_double, 4);
    EXPECT_LE(errors.of_float, 1);
}

// Where barycentric coordinates lose most: on needles, and beside them by less than they are high.
TEST_F(PointFinderTest, OnNeedlesAndBesideThem) {
    std::mt19937 random(12);
    for (int exponent = 3; exponent <= 60; exponent += 3) {
        Soup needle;
        const vec3 from = test::uniform3(random, -1, 1), along = test::uniform3(random, -1, 1);
        const vec3 across = test::uniform3(random, -1, 1) * std::ldexp(1.0f, -exponent);
        needle.add(from, from + along, from + along * 0.3f + across);
        set(needle.view());
        const Corners64& t = placed().front().corners;
        std::vector<dvec3> points;
        for (int i = 0; i < 200; ++i) {
            const double u = test::uniform(random, 0, 1), v = test::uniform(random, 0, 1) * (1 - u);
            points.push_back(t.a + u * (t.b - t.a) + v * (t.c - t.a));
            if (i % 2 == 0) points.back() += dvec3(test::uniform3(random, -1, 1)) * std::ldexp(1.0, -exponent - i % 8);
        }
        EXPECT_LE(errors_of(points).of_double, 4) << "height of 2^-" << exponent;
    }
}

// Differences of coordinates that float32 cannot hold.
TEST_F(PointFinderTest, AtTheEndsOfFloat32) {
    Soup huge;
    huge.add(vec3(-3e38f, 0, 0), vec3(-3e38f, 1e37f, 0), vec3(-3e38f, 0, 1e37f));
    huge.add(vec3(-1e38f, 0, 0), vec3(-1e38f, 1e37f, 0), vec3(-1e38f, 0, 1e37f));
    set(huge.view());
    EXPECT_EQ(finder().closest(std::vector{dvec3(3e38, 0, 0)}).front().triangle, 1u);
    EXPECT_EQ(finder().within(std::vector{dvec3(3e38, 0, 0)}, 5e38).size(), 1u);
}

TEST_F(PointFinderTest, FarAndOnTheSurface) {
    const Mesh ball = make_icosphere(3);
    set(ball);
    EXPECT_LE(errors_of(random_points(200, 1e9f, 2)).of_double, 4);
    std::vector<dvec3> on_it(ball.positions.begin(), ball.positions.end());
    for (const uvec3& t : ball.triangles) on_it.push_back((on_it[t.x] + on_it[t.y]) * 0.5);
    const std::vector<ClosestPoint> found = finder().closest(on_it);
    for (std::size_t i = 0; i < on_it.size(); ++i) {
        EXPECT_LE(found[i].distance, 0x1p-51);
        if (i < ball.positions.size()) {
            EXPECT_EQ(found[i].distance, 0);
        }
    }
}

// Bounds of boxes are float32: nothing may be passed over where they would over- or underflow.
TEST_F(PointFinderTest, SizeDoesNotMatter) {
    const Soup soup = mixed_soup(200, 9);
    const std::vector<dvec3> points = random_points(200, 2, 4);
    set(soup.view());
    const std::vector<ClosestPoint> of_one = finder().closest(points);
    for (const int exponent : {-120, -70, 70, 120}) {
        Soup scaled = soup;
        for (vec3& p : scaled.positions)
            p = vec3(std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent));
        std::vector<dvec3> scaled_points = points;
        for (dvec3& p : scaled_points) p *= std::ldexp(1.0, exponent);
        set(scaled.view());
        const std::vector<ClosestPoint> found = finder().closest(scaled_points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_EQ(found[i].triangle, of_one[i].triangle) << exponent;
            EXPECT_EQ(found[i].distance, std::ldexp(of_one[i].distance, exponent)) << exponent;
        }
    }
}

TEST_F(PointFinderTest, OfSeveralAtOneDistanceTheFirst) {
    const Mesh ball = make_icosphere(1);
    set({ball}, {{0, {}}, {0, {}}, {0, {}}});
    for (const ClosestPoint& found : finder().closest(random_points(100, 2, 6))) EXPECT_EQ(found.instance, 0u);
}

// From outside, all triangles around a corner are as near, and the same bits say so.
TEST_F(PointFinderTest, OfTheTrianglesAroundACornerTheFirst) {
    const Mesh ball = make_icosphere(1);
    const Transform turn = test::rotation(0.3f, 1.1f);
    set({ball}, {{0, turn}});
    const auto corner_of = [&](uint triangle, int k) {
        const Corners64& t = placed()[triangle].corners;
        return k == 0 ? t.a : k == 1 ? t.b : t.c;
    };
    for (uint corner = 0; corner < ball.positions.size(); ++corner) {
        const auto has_it = [&](const uvec3& t) { return t.x == corner || t.y == corner || t.z == corner; };
        const auto lowest = static_cast<uint>(std::find_if(ball.triangles.begin(), ball.triangles.end(), has_it) -
                                              ball.triangles.begin());
        const uvec3 t = ball.triangles[lowest];
        const dvec3 at = corner_of(lowest, t.x == corner ? 0 : t.y == corner ? 1 : 2);
        for (const double height : {0.0, 0.1, 0.7, 3.0})
            EXPECT_EQ(finder().closest(std::vector{at * (1 + height)}).front().triangle, lowest)
                << corner << ' ' << height;
    }
}

TEST_F(PointFinderTest, TheLargestDistanceCountsAsNear) {
    set(make_box(vec3(-1), vec3(1)));
    const std::vector points = {dvec3(3, 0, 0)};
    EXPECT_TRUE(finder().closest(points, 2).front().is_found);
    EXPECT_FALSE(finder().closest(points, std::nextafter(2.0, 0.0)).front().is_found);
    EXPECT_EQ(finder().within(points, 2).size(), 2u);
    EXPECT_TRUE(finder().within(points, std::nextafter(2.0, 0.0)).empty());
    EXPECT_TRUE(finder().closest(std::vector{dvec3(1)}, 0).front().is_found);
}

TEST_F(PointFinderTest, AllTrianglesWithinTheRadius) {
    const Soup soup = mixed_soup(150, 7);
    std::mt19937 random(1);
    set({soup.view()}, {{0, {}}, {0, turned(random, 1)}});
    const std::vector<dvec3> points = random_points(150, 1.5f, 3);
    std::size_t count = 0;
    const std::vector<NearTriangle> near = finder().within(points, 0.6);
    for (uint i = 0; i < points.size(); ++i)
        for (const PlacedTriangle& each : placed()) {
            const long double distance = test::distance(points[i], each.corners);
            if (distance > 0.6L) continue;
            ASSERT_LT(count, near.size());
            EXPECT_EQ(near[count].point, i);
            EXPECT_EQ(near[count].instance, each.instance);
            EXPECT_EQ(near[count].triangle, each.triangle);
            EXPECT_NEAR(near[count].distance, static_cast<double>(distance), 0x1p-50);
            ++count;
        }
    EXPECT_EQ(near.size(), count);
    EXPECT_GT(count, 4 * points.size());  // more than there was room for at first

    finder().set_max_found(count - 1);
    try {
        finder().within(points, 0.6);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(std::to_string(count) + " pairs"), std::string::npos) << error.what();
    }
}

TEST_F(PointFinderTest, NotFiniteIsNearToNothing) {
    const Mesh ball = make_icosphere(0);
    set(ball);
    const std::vector points = {dvec3(NAN, 0, 0), dvec3(0, INFINITY, 0), dvec3(0, 0, 2)};
    const std::vector<ClosestPoint> found = finder().closest(points);
    EXPECT_FALSE(found[0].is_found || found[1].is_found);
    EXPECT_TRUE(found[2].is_found);
    EXPECT_EQ(finder().within(points, 10).size(), 20u);
    EXPECT_THROW(finder().closest(points, -1), Error);
    EXPECT_THROW(finder().within(points, NAN), Error);
    EXPECT_THROW(finder().within(points, INFINITY), Error);

    const std::vector<vec3> corners = {vec3(0), vec3(NAN, 0, 0), vec3(0, 1, 0)};
    const std::vector triangles = {uvec3(0, 1, 2)};
    set(MeshView("broken", corners, triangles));
    EXPECT_FALSE(finder().closest(points)[2].is_found);
    set({}, {});
    EXPECT_FALSE(finder().closest(points)[2].is_found);
    EXPECT_TRUE(finder().closest({}).empty());
    const std::vector outside = {uvec3(0, 1, 3)};
    EXPECT_THROW(set(MeshView("outside", corners, outside)), Error);
}

}  // namespace
}  // namespace twinray
