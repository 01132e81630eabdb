// SPDX-License-Identifier: MIT
#include "hwtlas/blas.h"

#include <gtest/gtest.h>

#include "engine/core/ray.h"

namespace twinray {
namespace {

const std::vector<vec3> corners = {vec3(9, 0, 0), vec3(9, 1, 0), vec3(8, 0, 0), vec3(0, 0, 0),
                                   vec3(1, 0, 0), vec3(0, 1, 0), vec3(NAN),     vec3(0, -INFINITY, 0)};

Geometry geometry_of(const std::vector<uvec3>& triangles) { return Geometry(MeshView("mesh", corners, triangles)); }

TEST(BlasInput, OfAFiniteMeshInInputOrderIsTheMesh) {
    const std::vector<uvec3> triangles = {uvec3(0, 1, 2), uvec3(3, 4, 5)};
    const BlasInput input = blas_input(geometry_of(triangles), false);
    EXPECT_EQ(input.triangles, triangles);
    EXPECT_TRUE(input.original.empty());
}

TEST(BlasInput, RemembersWhereReorderedTrianglesCameFrom) {
    const BlasInput input = blas_input(geometry_of({uvec3(0, 1, 2), uvec3(3, 4, 5)}), true);
    EXPECT_EQ(input.triangles, (std::vector<uvec3>{uvec3(3, 4, 5), uvec3(0, 1, 2)}));
    EXPECT_EQ(input.original, (std::vector<uint>{1, 0}));
}

TEST(BlasInput, CollapsesNonFiniteTrianglesOntoOneCornerOfAnActiveOne) {
    const std::vector<uvec3> triangles = {uvec3(0, 1, 6), uvec3(3, 4, 5), uvec3(7, 7, 7)};
    const BlasInput kept = blas_input(geometry_of(triangles), false);
    EXPECT_EQ(kept.triangles, (std::vector<uvec3>{uvec3(3), uvec3(3, 4, 5), uvec3(3)}));
    const BlasInput reordered = blas_input(geometry_of(triangles), true);
    EXPECT_EQ(reordered.triangles, (std::vector<uvec3>{uvec3(3, 4, 5), uvec3(3), uvec3(3)}));
    EXPECT_EQ(reordered.original, (std::vector<uint>{1, 0, 2}));
}

TEST(BlasInput, HoldsFinitePositionsOnly) {
    for (const vec3& position : blas_input(geometry_of({uvec3(0, 1, 2)}), false).positions)
        EXPECT_TRUE(is_finite(position));
}

TEST(BlasInput, WithoutAnActiveTriangleIsEmpty) {
    EXPECT_TRUE(blas_input(geometry_of({}), true).is_empty());
    EXPECT_TRUE(blas_input(geometry_of({uvec3(0, 1, 6), uvec3(7, 0, 1)}), true).is_empty());
    EXPECT_TRUE(blas_input(geometry_of({uvec3(0, 0, 0), uvec3(0, 1, 1)}), true).is_empty());
    EXPECT_FALSE(blas_input(geometry_of({uvec3(0, 0, 0), uvec3(3, 4, 5)}), true).is_empty());
}

}  // namespace
}  // namespace twinray
