// SPDX-License-Identifier: MIT
#include "validation/reference/coverage.h"

#include <gtest/gtest.h>

#include <utility>

#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

// The triangles of the mesh as the ray sees them.
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

TEST(Coverage, OfAnInteriorPointIsCertain) {
    EXPECT_EQ(coverage_of(fan(5, true), make_ray({0.2f, 0.1f, 0}, {0, 0, 1})), Coverage::certain);
}

TEST(Coverage, OfAnInteriorPointIsCertainBesideATriangleOfWhichLittleIsKnown) {
    Soup soup = fan(5, true);
    soup.add({1e6f, 1e6f, 4}, {-1e6f, 1e6f, 6}, {0, -0.5f, 5});
    EXPECT_EQ(coverage_of(soup, make_ray({0.2f, 0.1f, 0}, {0, 0, 1})), Coverage::certain);
}

TEST(Coverage, OfTheVertexOfAClosedFanIsCertain) {
    for (const uint valence : {3u, 4u, 7u, 500u})
        EXPECT_EQ(coverage_of(fan(valence, true), at_center), Coverage::certain) << valence;
}

TEST(Coverage, OfTheVertexOfAnOpenFanIsOpen) {
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

TEST(Coverage, OfASharedEdgeIsCertainUnlessTheVerticesDiffer) {
    Soup soup;
    soup.add({0, -1, 4}, {0, 1, 4}, {1, 0, 4});
    soup.add({0, -1, 4}, {0, 1, 4}, {-1, 0, 4});
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::certain);
    soup.positions[4].y = 2;
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::unresolved);
    soup.positions[4].y = 1;
    soup.positions[0].x = -0.0f;  // still the same position
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::certain);
}

TEST(Coverage, OfAThirdTriangleOnAnEdgeIsUnresolvedButCopiesDoNotCount) {
    Soup soup;
    soup.add({0, -1, 4}, {0, 1, 4}, {1, 0, 4});
    soup.add({0, -1, 4}, {0, 1, 4}, {-1, 0, 4});
    soup.add({-1, 0, 4}, {0, 1, 4}, {0, -1, 4});
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::certain);
    soup.add({0, -1, 4}, {0, 1, 4}, {-1, 0, 3});
    EXPECT_EQ(coverage_of(soup, at_center), Coverage::unresolved);
}

}  // namespace
}  // namespace twinray
