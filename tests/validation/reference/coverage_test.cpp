// Bounds of how far rounding may move a ray, and whether triangles cover it wherever it is.

#include <gtest/gtest.h>

#include <utility>

#include "tests/validation/reference/meshes.h"
#include "validation/reference/error_bounds.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

constexpr double e16 = 16 * 0x1p-24;
const Ray along_z = make_ray(vec3(0), {0, 0, 2});

TriangleBound bound(const Triangle64& triangle, const Transform& transform = {},
                    Accelerator accelerator = Accelerator::software) {
    return ErrorBounds(along_z, Placement64(transform, "test"), accelerator).bound(triangle);
}

const Triangle64 facing = {dvec3(-3, -3, 4), dvec3(3, -3, 4), dvec3(0, 3, 4)};

TEST(ErrorBounds, BoundOfAFacingTriangle) {
    const TriangleBound seen = bound(facing);
    EXPECT_DOUBLE_EQ(seen.radius, e16 * std::sqrt(34.0));
    EXPECT_NEAR(seen.margin, 3 / std::sqrt(5.0), 1e-12);  // to the slanted sides
    EXPECT_DOUBLE_EQ(seen.t, 2);
    EXPECT_NEAR(seen.t_low, 2 - seen.radius / 2, 1e-12);
    EXPECT_NEAR(seen.t_high, 2 + seen.radius / 2, 1e-12);
    EXPECT_NEAR(seen.distance_to(0.25, 0.5), 0, 1e-12);
    EXPECT_NEAR(seen.distance_to(1, 0), std::sqrt(18.0), 1e-12);
}

TEST(ErrorBounds, MarginIsNegativeOutsideAndEdgeOn) {
    EXPECT_NEAR(bound({dvec3(1, -3, 4), dvec3(3, -3, 4), dvec3(1, 3, 4)}).margin, -1, 1e-12);
    EXPECT_NEAR(bound({dvec3(2, -1, 4), dvec3(2, 1, 4), dvec3(2, 0, 9)}).margin, -2, 1e-12);
    EXPECT_EQ(bound({dvec3(0, -1, 4), dvec3(0, 1, 4), dvec3(0, 0, 9)}).margin, 0);
}

TEST(ErrorBounds, SteepTrianglesHaveWiderBoundsThatEndAtTheirVertices) {
    const TriangleBound steep = bound({dvec3(-1, -1, 0), dvec3(-1, 1, 0), dvec3(1, 0, 2000)});
    EXPECT_GT(steep.t_high - steep.t_low, 500 * 2 * steep.radius);
    EXPECT_LT(steep.t_high - steep.t_low, 100);
    for (const double width : {0.0, 1e-7}) {  // within the radius: rounding chooses the point
        const TriangleBound sliver = bound({dvec3(-1, -width, 4), dvec3(1, -width, 8), dvec3(0, width, 6)});
        EXPECT_NEAR(sliver.t_low, 2, 1e-5) << width;
        EXPECT_NEAR(sliver.t_high, 4, 1e-5) << width;
        EXPECT_EQ(sliver.point_error, INFINITY) << width;
    }
}

TEST(ErrorBounds, TransformsAddTheErrorOfOriginAndDirection) {
    // The inverse maps (0, 0, 2) to (-200, 0, 2): a rounding of its entry 100 displaces the ray in proportion to t.
    const Transform sheared = {{vec4(1, 0, 100, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)}};
    const TriangleBound near = bound(facing, sheared);
    Triangle64 moved = facing;
    for (dvec3& vertex : moved) vertex += dvec3(-1e6, 0, 1e4);
    const TriangleBound far = bound(moved, sheared);
    EXPECT_NEAR(near.radius / bound(facing).radius, 2, 1e-3);  // |W||d| = |W d| here
    EXPECT_NEAR(far.radius / bound(moved).radius, 2, 1e-3);

    const TriangleBound shifted = bound(facing, Transform::translation({0, 0, 1000}));
    EXPECT_NEAR(shifted.radius, e16 * 2000, e16 * 1100);
    EXPECT_GT(bound(facing, sheared, Accelerator::hardware).radius, 100 * near.radius);  // condition 201
}

TEST(ErrorBounds, NoTriangleInABoxExceedsItsMaxRadius) {
    std::mt19937 random(5);
    const ErrorBounds bounds(along_z, Placement64(rotation(0.5f, 0.3f), "test"), Accelerator::hardware);
    for (int i = 0; i < 1000; ++i) {
        Box64 box;
        Triangle64 triangle;
        for (dvec3& vertex : triangle) box.include(vertex = dvec3(uniform3(random, -9, 9)));
        ASSERT_LE(bounds.bound(triangle).radius, bounds.max_radius(box)) << "seed 5";
    }
}

// Returns the coverage by the mesh's triangles as the ray sees them.
Coverage coverage_of(const Soup& soup, const Ray& ray) {
    const ErrorBounds bounds(ray, Placement64(), Accelerator::software);
    std::vector<PatchTriangle> patch;
    for (const uvec3& t : soup.triangles) {
        const std::array<vec3, 3> vertices = {soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]};
        patch.push_back({vertices, bounds.bound({dvec3(vertices[0]), dvec3(vertices[1]), dvec3(vertices[2])})});
    }
    return coverage(patch);
}

Soup fan(uint valence, bool is_closed) {
    Soup soup;
    const auto rim = [&](uint i) {
        const float angle = 6.2831853f * static_cast<float>(i % valence) / static_cast<float>(valence);
        return vec3(std::cos(angle), std::sin(angle), 4);
    };
    for (uint i = 0; i < (is_closed ? valence : valence - 1); ++i) soup.add({0, 0, 5}, rim(i), rim(i + 1));
    return soup;
}

const Ray at_center = make_ray(vec3(0), {0, 0, 1});

TEST(Coverage, OfNothingIsOpen) { EXPECT_EQ(coverage({}), Coverage::open); }

TEST(Coverage, OfAnInteriorPointIsCertainAlsoBesideATriangleOfWhichLittleIsKnown) {
    Soup soup = fan(5, true);
    const Ray interior = make_ray({0.2f, 0.1f, 0}, {0, 0, 1});
    EXPECT_EQ(coverage_of(soup, interior), Coverage::certain);
    soup.add({1e6f, 1e6f, 4}, {-1e6f, 1e6f, 6}, {0, -0.5f, 5});
    EXPECT_EQ(coverage_of(soup, interior), Coverage::certain);
}

TEST(Coverage, OfTheVertexOfAFanIsCertainWhereItIsClosed) {
    for (const uint valence : {3u, 4u, 7u, 500u})
        EXPECT_EQ(coverage_of(fan(valence, true), at_center), Coverage::certain) << valence;
    for (const uint valence : {3u, 4u, 7u}) EXPECT_EQ(coverage_of(fan(valence, false), at_center), Coverage::open);
}

TEST(Coverage, OfACrackThinnerThanRoundingIsUnresolved) {
    // A vertex that is one ulp off along the ray opens no gap, but nothing joins the four triangles there.
    Soup soup = fan(4, true);
    soup.positions[0].z = std::nextafter(5.0f, 6.0f);  // no longer the same vertex
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::unresolved);
}

TEST(Coverage, OfAFoldIsOpenInEitherWinding) {
    for (const float side : {1.0f, -1.0f}) {
        Soup soup;
        soup.add({0, -1, 4}, {0, 1, 4}, {side, 0, 4});
        soup.add({0, 1, 4}, {0, -1, 4}, {side, 0, 5});
        EXPECT_EQ(coverage_of(soup, at_center), Coverage::open);
        std::swap(soup.triangles[1].x, soup.triangles[1].y);
        EXPECT_EQ(coverage_of(soup, at_center), Coverage::open);
    }
}

// Two triangles that share the edge x = 0.
Soup halved_square() {
    Soup soup;
    soup.add({0, -1, 4}, {0, 1, 4}, {1, 0, 4});
    soup.add({0, -1, 4}, {0, 1, 4}, {-1, 0, 4});
    return soup;
}

TEST(Coverage, OfASharedEdgeIsCertainUnlessTheVerticesDiffer) {
    Soup soup = halved_square();
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::certain);
    soup.positions[4].y = 2;
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::unresolved);
    soup.positions[4].y = 1;
    soup.positions[0].x = -0.0f;  // still the same position
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::certain);
}

TEST(Coverage, OfAThirdTriangleOnAnEdgeIsUnresolvedButCopiesDoNotCount) {
    Soup soup = halved_square();
    soup.add({-1, 0, 4}, {0, 1, 4}, {0, -1, 4});
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::certain);
    soup.add({0, -1, 4}, {0, 1, 4}, {-1, 0, 3});
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::unresolved);
}

}  // namespace
}  // namespace twinray
