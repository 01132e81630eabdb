// Closed meshes, what lies inside them, and rays from there.
#include "validation/leaks/closed_mesh.h"

#include <gtest/gtest.h>

#include <cstring>

#include "engine/core/error.h"
#include "tests/scene/temp_dir.h"
#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

std::optional<OpenEdge> open_edge_of(const Soup& soup) { return find_open_edge(Geometry64(soup.view())); }

// No two triangles share a vertex, only positions.
Soup unshared(const Soup& soup) {
    Soup result;
    for (const uvec3& t : soup.triangles) result.add(soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]);
    return result;
}

void append(Soup& soup, const Soup& other, float scale, vec3 offset) {
    const uint first = static_cast<uint>(soup.positions.size());
    for (const vec3& position : other.positions) soup.positions.push_back(position * scale + offset);
    for (const uvec3& triangle : other.triangles) soup.triangles.push_back(triangle + first);
}

// A wall between two spheres: a hole in the middle.
Soup hollow_sphere() {
    Soup soup = sphere(4);
    append(soup, sphere(4), 0.5f, vec3(0));
    return soup;
}

std::string refusal_of(const Soup& soup) {
    return error_of([&] { ClosedMesh{soup.view()}; });
}

TEST(ClosedMesh, VerticesAreEqualIfTheirPositionsAre) {
    EXPECT_FALSE(open_edge_of(cube()));
    EXPECT_FALSE(open_edge_of(sphere(3)));
    EXPECT_FALSE(open_edge_of(hollow_sphere()));
    Soup apart = unshared(cube());
    EXPECT_FALSE(open_edge_of(apart));
    for (std::size_t i = 0; i < apart.positions.size(); i += 2)
        for (int axis = 0; axis < 3; ++axis)
            if (apart.positions[i][axis] == 0) apart.positions[i][axis] = -0.0f;
    EXPECT_FALSE(open_edge_of(apart)) << "0 and -0 are the same place";
    apart.positions[0].x += 1e-7f;
    EXPECT_TRUE(open_edge_of(apart));
}

TEST(ClosedMesh, AnEdgeOfAMissingTriangleIsOpen) {
    for (std::size_t missing = 0; missing < cube().triangles.size(); ++missing) {
        Soup open = cube();
        open.triangles.erase(open.triangles.begin() + static_cast<std::ptrdiff_t>(missing));
        const auto edge = open_edge_of(open);
        ASSERT_TRUE(edge) << missing;
        EXPECT_EQ(edge->triangles, 1u);
    }
    Soup open = cube();
    open.triangles[0] = uvec3(0);
    const auto edge = open_edge_of(open);  // triangle 0 is (0, 2, 1), and triangle 1 has the edge 1-2
    ASSERT_TRUE(edge);
    EXPECT_EQ(edge->primitive, 1u);
    EXPECT_EQ(edge->vertices[0], vec3(0, 1, 0));
    EXPECT_EQ(edge->vertices[1], vec3(1, 0, 0));
    expect_contains(refusal_of(open),
                    "mesh 'test' is not closed: 1 triangle(s) share the edge from (0, 1, 0) to (1, 0, 0), "
                    "one of them triangle 1");
}

TEST(ClosedMesh, TwoShellsMayTouchAlongAnEdge) {
    Soup soup = cube();
    append(soup, cube(), 1, vec3(1, 1, 0));
    EXPECT_FALSE(open_edge_of(soup));
    append(soup, cube(), 1, vec3(1, 0, 0));  // and three of them, but a wall of two walls is no wall
    EXPECT_FALSE(open_edge_of(soup));
    soup.triangles.push_back(soup.triangles[0]);
    const auto edge = open_edge_of(soup);
    ASSERT_TRUE(edge);
    EXPECT_EQ(edge->triangles, 3u);
}

TEST(ClosedMesh, ADegenerateTriangleClosesNoTJunction) {
    Soup soup = cube();
    soup.positions.push_back(vec3(0.5f, 0.5f, 0));  // in the middle of the edge 1-2 of triangles 0 and 1
    soup.triangles[0] = {0, 2, 8};
    soup.triangles.push_back({0, 8, 1});
    EXPECT_TRUE(open_edge_of(soup));
    soup.triangles.push_back({1, 8, 2});  // would close it by indices
    EXPECT_TRUE(open_edge_of(soup));
}

TEST(ClosedMesh, NothingIsEnclosedByNothing) {
    expect_contains(refusal_of({}), "has no triangle with an area");
    Soup two_sided;
    two_sided.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    two_sided.add({0, 0, 0}, {0, 1, 0}, {1, 0, 0});
    EXPECT_NO_THROW(ClosedMesh{two_sided.view()});
    EXPECT_THROW(ClosedMesh(two_sided.view()).points_inside(16, 1), Error);
}

TEST(ClosedMesh, CrossingsAreCounted) {
    const Soup soup = hollow_sphere();
    const ClosedMesh hollow(soup.view());
    const dvec3 direction(0.3, -0.5, 0.7);
    EXPECT_EQ(hollow.crossings(dvec3(0), direction), 2u);
    EXPECT_EQ(hollow.crossings(0.8 * normalize(direction), direction), 1u);
    EXPECT_EQ(hollow.crossings(-0.8 * normalize(direction), direction), 3u);
    EXPECT_EQ(hollow.crossings(-3.0 * direction, direction), 4u);
    EXPECT_EQ(hollow.crossings(3.0 * direction, direction), 0u);
}

TEST(ClosedMesh, DistancesAreThoseToTheNearestTriangle) {
    const Soup soup = cube();
    const ClosedMesh closed(soup.view());
    const auto expect_distance = [&](const dvec3& point, double distance) {
        EXPECT_TRUE(closed.comes_within(distance * 1.0001, point)) << distance;
        EXPECT_FALSE(closed.comes_within(distance * 0.9999, point)) << distance;
    };
    expect_distance({0.5, 0.45, 0.3}, 0.3);                  // to a face
    expect_distance({-3, -4, 0.25}, 5);                      // to an edge
    expect_distance({-1, -1, -1}, std::sqrt(3));             // to a vertex
    expect_distance({1.25, 0.5, 0.5}, 0.25);                 // from outside
    EXPECT_TRUE(closed.comes_within(1e-12, {0.3, 0.3, 0}));  // on it
}

TEST(ClosedMesh, PointsInsideAreInTheWall) {
    const Soup soup = hollow_sphere();
    const ClosedMesh hollow(soup.view());
    const std::vector<vec3> points = hollow.points_inside(200, 5);
    ASSERT_EQ(points.size(), 200u);
    for (const vec3& point : points) {
        EXPECT_GT(length(point), 0.49f);
        EXPECT_LT(length(point), 1.0f);
        EXPECT_FALSE(hollow.comes_within(hollow.clearance(), point));
    }
    const std::vector<vec3> few = hollow.points_inside(3, 5), other = hollow.points_inside(3, 6);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(few[i] == points[i] && other[i] != points[i]) << i;
}

TEST(ClosedMesh, PointsInsideKeepAwayFromTheTriangles) {
    const auto slab = [](float thickness) {
        Soup soup = cube();
        for (vec3& position : soup.positions) position.z *= thickness;
        return soup;
    };
    const Soup thin = slab(1.5e-4f), too_thin = slab(1.2e-4f);
    const ClosedMesh closed(thin.view());
    EXPECT_EQ(closed.clearance(), 0x1p-14);
    const std::vector<vec3> points = closed.points_inside(100, 1);
    EXPECT_EQ(points.size(), 100u);
    for (const vec3& point : points) {
        EXPECT_GE(point.z, 0x1p-14f);
        EXPECT_LE(point.z, 1.5e-4f - 0x1p-14f);
    }
    EXPECT_THROW(ClosedMesh(too_thin.view()).points_inside(100, 1), Error);
}

double nearest_vertex(const Soup& soup, const Ray& ray) {
    double nearest = INFINITY;
    for (const vec3& position : soup.positions) nearest = std::min(nearest, distance_to_line(position, ray));
    return nearest;
}

class InsideRaysTest : public ::testing::Test {
  protected:
    const Soup soup_ = sphere(2);
    const ClosedMesh closed_{soup_.view()};
};

TEST_F(InsideRaysTest, StartInsideAndPassTheirTargets) {
    std::size_t at_vertices = 0;
    const std::vector<Ray> both = InsideRays(closed_, Aim::both, 3).rays(0, 400);
    for (std::size_t i = 0; i < both.size(); ++i) {
        ASSERT_TRUE(is_traceable(both[i]));
        EXPECT_LT(length(both[i].origin), 1.0f);
        const bool at_vertex = nearest_vertex(soup_, both[i]) < 1e-6;
        EXPECT_TRUE(at_vertex || i % 2 == 1) << i;
        at_vertices += at_vertex;
    }
    EXPECT_LT(at_vertices, 210u) << "points of edges are not vertices";
    for (const Ray& ray : InsideRays(closed_, Aim::vertices, 3).rays(0, 100))
        EXPECT_LT(nearest_vertex(soup_, ray), 1e-6);
}

TEST_F(InsideRaysTest, RayIDependsOnSeedAndIndexAlone) {
    const InsideRays rays(closed_, Aim::both, 3), other(closed_, Aim::both, 4);
    const std::vector<Ray> all = rays.rays(0, 1000), tail = rays.rays(990, 10);
    for (std::size_t i = 0; i < tail.size(); ++i) {
        EXPECT_EQ(std::memcmp(&tail[i], &all[990 + i], sizeof(Ray)), 0) << i;
        const Ray of_other = other.ray(990 + i);
        EXPECT_NE(std::memcmp(&tail[i], &of_other, sizeof(Ray)), 0) << i;
    }
}

TEST_F(InsideRaysTest, EvenCountsAreLeaksOrDoubleHits) {
    for (const Ray& ray : InsideRays(closed_, Aim::both, 3).rays(0, 200)) {
        EXPECT_EQ(check_crossings(closed_, ray, 1), Parity::odd);
        EXPECT_EQ(check_crossings(closed_, ray, 0), Parity::leak);
        EXPECT_EQ(check_crossings(closed_, ray, 2), Parity::double_hit);
        EXPECT_EQ(check_crossings(closed_, ray, 3), Parity::odd);  // parity cannot see this
    }
}

TEST(InsideRays, ATriangleSeenEdgeOnAtTheOriginDecidesNothing) {
    const Soup soup = cube();
    const ClosedMesh closed(soup.view());
    const vec3 direction(0.6f, 0.8f, 0);
    EXPECT_EQ(check_crossings(closed, make_ray({0.5f, 0.4f, 1e-8f}, direction), 2), Parity::unspecified);
    EXPECT_EQ(check_crossings(closed, make_ray({0.5f, 0.4f, 1e-3f}, direction), 2), Parity::double_hit);
}

}  // namespace
}  // namespace twinray
