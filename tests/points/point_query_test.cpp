// The nearest triangles of points, by the GPU, compared with all triangles one by one.
#include <twinray/queries.h>

#include <cstdlib>

#include "engine/core/parallel.h"
#include "tests/accel/accel_fixture.h"
#include "tests/points/point_reference.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

using test::PlacedTriangle;
using test::random_points;
using test::Soup;

class PointQueryTest : public test::VulkanTest {
  protected:
    void prepare() override {
        if (!context().properties().shader_float64) TWINRAY_LACKS("float64", "no float64");
        query_ = &keep<PointQuery>(context());
    }
    PointQuery& query() { return *query_; }
    void set(const std::vector<MeshView>& meshes, const std::vector<MeshInstance>& instances) {
        query_->set(meshes, instances);
        placed_ = test::placed_triangles(meshes, instances);
        sides_.clear();
        for (const PlacedTriangle& each : placed_) sides_.push_back(side_of(each.vertices));
    }
    void set(const MeshView& mesh) { set({mesh}, {{0, {}}}); }
    const std::vector<PlacedTriangle>& placed() const { return placed_; }

    // The largest error of closest() in units of the last place of a double and of a float, for distances that are
    // exact to a double of the size of their operands. The test fails if another triangle is nearer.
    struct Errors {
        double of_double = 0, of_float = 0;
    };
    Errors errors_of(std::span<const dvec3> points) {
        const std::vector<ClosestPoint> found = query().closest(points);
        std::vector<Errors> errors(points.size());
        std::vector<std::size_t> wrong(points.size(), 0);
        parallel_for(points.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                errors[i] = error_if_any(points[i], found[i]);
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
    Errors error_if_any(const dvec3& point, const ClosestPoint& found) const {
        const auto is_found = [&](const PlacedTriangle& each) {
            return each.instance == found.instance && each.triangle == found.triangle;
        };
        const auto own = std::find_if(placed_.begin(), placed_.end(), is_found);
        if (own == placed_.end()) return {INFINITY, INFINITY};
        const long double of_named = test::distance(point, own->vertices);
        long double least = of_named;
        double size = side_of(own->vertices);
        for (std::size_t i = 0; i < placed_.size(); ++i) {
            const WorldTriangle& vertices = placed_[i].vertices;
            const double to_vertex = length(point - vertices.a);
            if (to_vertex - sides_[i] > static_cast<double>(least) + 1e-9 * to_vertex) continue;
            const long double distance = test::distance(point, vertices);
            if (distance < least) {
                least = distance;
                size = sides_[i];
            }
        }
        const auto reached = static_cast<long double>(length(found.position - point));
        const double unit = std::max({static_cast<double>(least), size, length(point)}) * 0x1p-52;
        const WorldTriangle& t = own->vertices;
        const dvec3 by_uv = (1 - found.u - found.v) * t.a + found.u * t.b + found.v * t.c;
        const long double error =
            std::max({std::abs(found.distance - least), std::abs(reached - least), of_named - least,
                      static_cast<long double>(length(by_uv - found.position)) / 4});
        const auto as_float = static_cast<float>(least);
        return {static_cast<double>(error) / unit,
                std::abs(static_cast<double>(static_cast<float>(found.distance)) - as_float) /
                    (std::nextafter(as_float, INFINITY) - as_float)};
    }
    static double side_of(const WorldTriangle& t) {
        return std::max({length(t.a - t.b), length(t.b - t.c), length(t.c - t.a)});
    }

    PointQuery* query_ = nullptr;
    std::vector<PlacedTriangle> placed_;
    std::vector<double> sides_;  // the longest of each
};

// Returns TWINRAY_POINTS, or as many as take a second.
std::size_t point_count() {
    const char* asked = std::getenv("TWINRAY_POINTS");
    return asked ? std::stoul(asked) : 2'000;
}

// Triangles of every shape: without area, without length, needles.
Soup mixed_soup(std::size_t count, unsigned seed) {
    Soup soup = test::random_soup(count, 0.3f, seed);
    for (std::size_t i = 0; i < count; ++i) {
        vec3* vertices = &soup.positions[3 * i];
        if (i % 7 == 1) vertices[1] = vertices[0];
        if (i % 7 == 2) vertices[1] = vertices[2] = vertices[0];
        if (i % 7 == 3) vertices[2] = vertices[0] + (vertices[1] - vertices[0]) * 0.75f;
        if (i % 7 == 4) vertices[2] = vertices[1] + (vertices[2] - vertices[1]) * 0x1p-20f;
    }
    return soup;
}

TEST_F(PointQueryTest, TheNearestTriangleIsFoundWhateverItsShape) {
    const Soup soup = mixed_soup(300, 5);
    const Mesh ball = make_icosphere(2, 0.7f);
    std::mt19937 random(3);
    set({soup.view(), ball},
        {{0, {}}, {1, test::random_instance_transform(random, 2)}, {0, test::random_instance_transform(random, 2)}});
    const Errors errors = errors_of(random_points(point_count(), 3, 8));
    RecordProperty("double_ulp", std::to_string(errors.of_double));
    RecordProperty("float_ulp", std::to_string(errors.of_float));
    std::cout << "largest error: " << errors.of_double << " ulp of float64, " << errors.of_float << " of float32\n";
    EXPECT_LE(errors.of_double, 4);
    EXPECT_LE(errors.of_float, 1);
}

// Barycentric coordinates lose most on needles, and beside them at less than their height.
TEST_F(PointQueryTest, OnNeedlesAndBesideThem) {
    std::mt19937 random(12);
    for (int exponent = 3; exponent <= 60; exponent += 3) {
        Soup needle;
        const vec3 from = test::uniform3(random, -1, 1), along = test::uniform3(random, -1, 1);
        const vec3 across = test::uniform3(random, -1, 1) * std::ldexp(1.0f, -exponent);
        needle.add(from, from + along, from + along * 0.3f + across);
        set(needle.view());
        const WorldTriangle& t = placed().front().vertices;
        std::vector<dvec3> points;
        for (int i = 0; i < 200; ++i) {
            const double u = test::uniform(random, 0, 1), v = test::uniform(random, 0, 1) * (1 - u);
            points.push_back(t.a + u * (t.b - t.a) + v * (t.c - t.a));
            if (i % 2 == 0) points.back() += dvec3(test::uniform3(random, -1, 1)) * std::ldexp(1.0, -exponent - i % 8);
        }
        EXPECT_LE(errors_of(points).of_double, 4) << "height of 2^-" << exponent;
    }
}

// Float32 cannot hold these differences of coordinates.
TEST_F(PointQueryTest, AtTheEndsOfFloat32) {
    Soup huge;
    huge.add(vec3(-3e38f, 0, 0), vec3(-3e38f, 1e37f, 0), vec3(-3e38f, 0, 1e37f));
    huge.add(vec3(-1e38f, 0, 0), vec3(-1e38f, 1e37f, 0), vec3(-1e38f, 0, 1e37f));
    set(huge.view());
    EXPECT_EQ(query().closest(std::vector{dvec3(3e38, 0, 0)}).front().triangle, 1u);
    EXPECT_EQ(query().within(std::vector{dvec3(3e38, 0, 0)}, 5e38).size(), 1u);
}

TEST_F(PointQueryTest, FarAndOnTheSurface) {
    const Mesh ball = make_icosphere(3);
    set(ball);
    EXPECT_LE(errors_of(random_points(200, 1e9f, 2)).of_double, 4);
    std::vector<dvec3> on_it(ball.positions.begin(), ball.positions.end());
    for (const uvec3& t : ball.triangles) on_it.push_back((on_it[t.x] + on_it[t.y]) * 0.5);
    const std::vector<ClosestPoint> found = query().closest(on_it);
    for (std::size_t i = 0; i < on_it.size(); ++i) {
        EXPECT_LE(found[i].distance, 0x1p-51);
        if (i < ball.positions.size()) {
            EXPECT_EQ(found[i].distance, 0);
        }
    }
}

// Bounds of boxes are float32: nothing may be passed over where they would over- or underflow.
TEST_F(PointQueryTest, SizeDoesNotMatter) {
    const Soup soup = mixed_soup(200, 9);
    const std::vector<dvec3> points = random_points(200, 2, 4);
    set(soup.view());
    const std::vector<ClosestPoint> of_one = query().closest(points);
    for (const int exponent : {-120, -70, 70, 120}) {
        Soup scaled = soup;
        for (vec3& p : scaled.positions)
            p = vec3(std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent));
        std::vector<dvec3> scaled_points = points;
        for (dvec3& p : scaled_points) p *= std::ldexp(1.0, exponent);
        set(scaled.view());
        const std::vector<ClosestPoint> found = query().closest(scaled_points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_EQ(found[i].triangle, of_one[i].triangle) << exponent;
            EXPECT_EQ(found[i].distance, std::ldexp(of_one[i].distance, exponent)) << exponent;
        }
    }
}

TEST_F(PointQueryTest, OfSeveralAtOneDistanceTheFirst) {
    const Mesh ball = make_icosphere(1);
    set({ball}, {{0, {}}, {0, {}}, {0, {}}});
    for (const ClosestPoint& found : query().closest(random_points(100, 2, 6))) EXPECT_EQ(found.instance, 0u);
}

// From outside, all triangles around a vertex are equally near, with the same bits.
TEST_F(PointQueryTest, OfTheTrianglesAroundACornerTheFirst) {
    const Mesh ball = make_icosphere(1);
    const Transform turn = test::rotation(0.3f, 1.1f);
    set({ball}, {{0, turn}});
    const auto vertex_of = [&](uint triangle, int k) {
        const WorldTriangle& t = placed()[triangle].vertices;
        return k == 0 ? t.a : k == 1 ? t.b : t.c;
    };
    for (uint vertex = 0; vertex < ball.positions.size(); ++vertex) {
        const auto has_it = [&](const uvec3& t) { return t.x == vertex || t.y == vertex || t.z == vertex; };
        const auto lowest = static_cast<uint>(std::find_if(ball.triangles.begin(), ball.triangles.end(), has_it) -
                                              ball.triangles.begin());
        const uvec3 t = ball.triangles[lowest];
        const dvec3 at = vertex_of(lowest, t.x == vertex ? 0 : t.y == vertex ? 1 : 2);
        for (const double height : {0.0, 0.1, 0.7, 3.0})
            EXPECT_EQ(query().closest(std::vector{at * (1 + height)}).front().triangle, lowest)
                << vertex << ' ' << height;
    }
}

TEST_F(PointQueryTest, TheLargestDistanceCountsAsNear) {
    set(make_box(vec3(-1), vec3(1)));
    const std::vector points = {dvec3(3, 0, 0)};
    EXPECT_TRUE(query().closest(points, 2).front().is_found);
    EXPECT_FALSE(query().closest(points, std::nextafter(2.0, 0.0)).front().is_found);
    EXPECT_EQ(query().within(points, 2).size(), 2u);
    EXPECT_TRUE(query().within(points, std::nextafter(2.0, 0.0)).empty());
    EXPECT_TRUE(query().closest(std::vector{dvec3(1)}, 0).front().is_found);
}

TEST_F(PointQueryTest, AllTrianglesWithinTheRadius) {
    const Soup soup = mixed_soup(150, 7);
    std::mt19937 random(1);
    set({soup.view()}, {{0, {}}, {0, test::random_instance_transform(random, 1)}});
    const std::vector<dvec3> points = random_points(150, 1.5f, 3);
    std::size_t count = 0;
    const std::vector<NearTriangle> near = query().within(points, 0.6);
    for (uint i = 0; i < points.size(); ++i)
        for (const PlacedTriangle& each : placed()) {
            const long double distance = test::distance(points[i], each.vertices);
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

    query().set_max_found(count - 1);
    test::expect_contains(test::error_of([&] { query().within(points, 0.6); }), std::to_string(count) + " pairs");
}

TEST_F(PointQueryTest, NotFiniteIsNearToNothing) {
    const Mesh ball = make_icosphere(0);
    set(ball);
    const std::vector points = {dvec3(NAN, 0, 0), dvec3(0, INFINITY, 0), dvec3(0, 0, 2)};
    const std::vector<ClosestPoint> found = query().closest(points);
    EXPECT_FALSE(found[0].is_found || found[1].is_found);
    EXPECT_TRUE(found[2].is_found);
    EXPECT_EQ(query().within(points, 10).size(), 20u);
    EXPECT_THROW(query().closest(points, -1), Error);
    EXPECT_THROW(query().within(points, NAN), Error);
    EXPECT_THROW(query().within(points, INFINITY), Error);

    const std::vector<vec3> vertices = {vec3(0), vec3(NAN, 0, 0), vec3(0, 1, 0)};
    const std::vector triangles = {uvec3(0, 1, 2)};
    set(MeshView("broken", vertices, triangles));
    EXPECT_FALSE(query().closest(points)[2].is_found);
    set({}, {});
    EXPECT_FALSE(query().closest(points)[2].is_found);
    EXPECT_TRUE(query().closest({}).empty());
    const std::vector outside = {uvec3(0, 1, 3)};
    EXPECT_THROW(set(MeshView("outside", vertices, outside)), Error);
}

}  // namespace
}  // namespace twinray
