// Builds that a sync makes: which changes refit a top level and which rebuild it, how many share a batch, the orders
// that keep neighbours together, of triangles and of rays, and what the driver is given.
#include "engine/accel/batches.h"

#include <algorithm>
#include <functional>
#include <random>

#include <gtest/gtest.h>
#include "engine/accel/morton_order.h"
#include "engine/accel/ray_sort.h"
#include "engine/core/ray.h"
#include "hwtlas/blas.h"

namespace twinray {
namespace {

constexpr SceneChange moved_again{.is_built = true, .was_moved = true, .built_count = 3, .count = 3};

SceneChange with(const std::function<void(SceneChange&)>& change) {
    SceneChange changed = moved_again;
    change(changed);
    return changed;
}

TEST(SceneUpdate, WhatOnlyMovedAgainIsRefitted) { EXPECT_FALSE(must_build(moved_again)); }

TEST(SceneUpdate, AnotherNumberOfInstancesRebuilds) {
    for (const std::size_t count : {0, 2, 4})
        EXPECT_TRUE(must_build(with([&](SceneChange& change) { change.count = count; }))) << count;
}

TEST(SceneUpdate, SoDoesAllElse) {
    EXPECT_TRUE(must_build({})) << "the first time";
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.was_moved = false; }))) << "the first move";
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.has_structure = true; })));
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.has_new_geometry = true; })));
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.has_degraded = true; })));
}

std::vector<std::size_t> counts_of(const std::vector<std::uint64_t>& bytes, std::uint64_t budget) {
    std::vector<std::size_t> counts;
    for (const Batches::Run& run : cut_into_batches(bytes, budget).runs) counts.push_back(run.count);
    return counts;
}

TEST(Batches, FillTheBudgetAndNoMore) {
    using Counts = std::vector<std::size_t>;
    EXPECT_EQ(counts_of({}, 10), Counts{});
    EXPECT_EQ(counts_of({4, 6}, 10), Counts{2});
    EXPECT_EQ(counts_of({4, 7}, 10), (Counts{1, 1}));
    EXPECT_EQ(counts_of({4, 6, 1, 9, 1}, 10), (Counts{2, 2, 1}));
    EXPECT_EQ(counts_of({1, 1, 1}, 0), (Counts{1, 1, 1}));
    EXPECT_EQ(counts_of({0, 0, 0}, 0), Counts{3});
    EXPECT_EQ(counts_of({3, 50, 3, 3}, 10), (Counts{1, 1, 2})) << "one that exceeds the budget goes alone";
    EXPECT_EQ(counts_of({UINT64_MAX, 1, 2}, UINT64_MAX), (Counts{1, 2}));
}

TEST(Batches, CoverEveryBuildOnceInOrder) {
    std::mt19937 random(1);
    for (int round = 0; round < 200; ++round) {
        std::vector<std::uint64_t> bytes(random() % 50);
        for (std::uint64_t& b : bytes) b = random() % 100;
        const std::uint64_t budget = random() % 200;
        const Batches batches = cut_into_batches(bytes, budget);
        std::size_t next = 0;
        std::uint64_t largest = 0;
        for (const Batches::Run& run : batches.runs) {
            ASSERT_EQ(run.first, next);
            ASSERT_GT(run.count, 0u);
            std::uint64_t sum = 0;
            for (std::size_t i = 0; i < run.count; ++i) sum += bytes[next++];
            EXPECT_TRUE(sum <= budget || run.count == 1);
            EXPECT_TRUE(next == bytes.size() || sum + bytes[next] > budget) << "another would have fitted";
            largest = std::max(largest, sum);
        }
        EXPECT_EQ(next, bytes.size());
        EXPECT_EQ(batches.scratch_bytes, largest);
    }
}

std::vector<vec3> cube_corners() {
    std::vector<vec3> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(i >> 2 & 1, i >> 1 & 1, i & 1);
    return corners;
}

TEST(MortonOrder, OfNothingIsEmpty) { EXPECT_TRUE(morton_order({}).empty()); }

TEST(MortonOrder, VisitsTheCornersOfACubeWithXSlowestAndZFastest) {
    const std::vector<vec3> corners = cube_corners();
    EXPECT_EQ(morton_order(corners), (std::vector<uint>{0, 1, 2, 3, 4, 5, 6, 7}));
    const std::vector<vec3> reversed(corners.rbegin(), corners.rend());
    EXPECT_EQ(morton_order(reversed), (std::vector<uint>{7, 6, 5, 4, 3, 2, 1, 0}));
}

TEST(MortonOrder, KeepsEqualCentersInOrder) {
    EXPECT_EQ(morton_order(std::vector<vec3>(5, vec3(3, -2, 1))), (std::vector<uint>{0, 1, 2, 3, 4}));
}

TEST(MortonOrder, PutsNonFiniteCentersLastInOrder) {
    const std::vector<vec3> centers = {vec3(NAN), vec3(1, 0, 0), vec3(0, INFINITY, 0), vec3(0), vec3(0, 0, -INFINITY)};
    EXPECT_EQ(morton_order(centers), (std::vector<uint>{3, 1, 0, 2, 4}));
    EXPECT_EQ(morton_order(std::vector<vec3>(3, vec3(NAN))), (std::vector<uint>{0, 1, 2}));
}

TEST(MortonOrder, TellsMoreThanAMillionCellsApartOnOneAxis) {
    const float step = 1.0f / (1 << 20);
    const std::vector<vec3> centers = {vec3(0), vec3(step * 5, 0, 0), vec3(step * 4, 0, 0), vec3(1, 0, 0)};
    EXPECT_EQ(morton_order(centers), (std::vector<uint>{0, 2, 1, 3}));
}

TEST(MortonOrder, SurvivesAnExtentBeyondTheLargestFloat) {
    const std::vector<vec3> centers = {vec3(3e38f, 0, 0), vec3(-3e38f, 0, 0), vec3(0)};
    EXPECT_EQ(morton_order(centers), (std::vector<uint>{1, 2, 0}));
}

TEST(MortonOrder, OfRandomPointsIsAPermutationWithShortSteps) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<vec3> centers(20000);
    for (vec3& center : centers) center = vec3(unit(random), unit(random), unit(random));
    const std::vector<uint> order = morton_order(centers);
    std::vector<uint> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    double total = 0, total_before = 0;
    for (uint i = 0; i < order.size(); ++i) {
        ASSERT_EQ(sorted[i], i);
        if (i == 0) continue;
        total += length(centers[order[i]] - centers[order[i - 1]]);
        total_before += length(centers[i] - centers[i - 1]);
    }
    EXPECT_LT(total, 0.1 * total_before);
}

TEST(TriangleCenters, AreThoseOfTheBoxesAndNanForNonFiniteCorners) {
    const std::vector<vec3> positions = {vec3(0), vec3(4, 0, 0), vec3(0, 2, -6), vec3(0, NAN, 0), vec3(INFINITY, 0, 0)};
    const std::vector<uvec3> triangles = {uvec3(0, 1, 2), uvec3(0, 1, 3), uvec3(4, 0, 1), uvec3(1, 1, 1)};
    const std::vector<vec3> centers = triangle_centers(positions, triangles);
    ASSERT_EQ(centers.size(), 4u);
    EXPECT_EQ(centers[0], vec3(2, 1, -3));
    EXPECT_TRUE(std::isnan(centers[1].x) && std::isnan(centers[2].x));
    EXPECT_EQ(centers[3], vec3(4, 0, 0));
}

constexpr float cells = 1u << RAY_CELL_BITS;

Ray from(const vec3& origin, const vec3& direction = vec3(1)) { return {origin, 0, direction, INFINITY}; }
GeometryBox box_of_cells() { return {vec3(0), vec3(cells)}; }

TEST(RayKey, FollowsTheCellsThenTheOctants) {
    const GeometryBox box = box_of_cells();
    EXPECT_EQ(ray_key(from(vec3(0.5f)), box), 0u);
    EXPECT_EQ(ray_key(from(vec3(0.5f, 0.5f, 1.5f)), box), 1u << 3);
    EXPECT_EQ(ray_key(from(vec3(0.5f, 1.5f, 0.5f)), box), 2u << 3);
    EXPECT_EQ(ray_key(from(vec3(1.5f, 0.5f, 0.5f)), box), 4u << 3);
    EXPECT_EQ(ray_key(from(vec3(2.5f, 0.5f, 0.5f)), box), 32u << 3);
    EXPECT_EQ(ray_key(from(vec3(1, 1, 1), vec3(-1, -1, -1)), box), (7u << 3) + 7u);
    for (uint octant = 0; octant < 8; ++octant) {
        const vec3 direction(octant & 4 ? -2 : 1, octant & 2 ? -1 : 0, octant & 1 ? -3 : 5);
        EXPECT_EQ(octant_of(direction), octant);
        EXPECT_EQ(ray_key(from(vec3(0.9f), direction), box), octant);
    }
}

TEST(RayKey, HasNoMoreThanItsBits) {
    const GeometryBox box = box_of_cells();
    EXPECT_EQ(ray_key(from(vec3(cells), vec3(-1)), box), LAST_RAY_KEY);
    EXPECT_EQ(ray_key(from(vec3(cells), vec3(1)), box), LAST_RAY_KEY - 7);
}

TEST(RayKey, IsTheLastOfRaysThatAreNotTraced) {
    const GeometryBox box = box_of_cells();
    EXPECT_EQ(ray_key(from(vec3(NAN, 0, 0)), box), LAST_RAY_KEY);
    EXPECT_EQ(ray_key(from(vec3(0, -INFINITY, 0)), box), LAST_RAY_KEY);
    EXPECT_EQ(ray_key(from(vec3(0), vec3(0)), box), LAST_RAY_KEY);
    EXPECT_EQ(ray_key({vec3(0), 1, vec3(1), 1}, box), LAST_RAY_KEY);
}

TEST(RayKey, NeedsNoBoxWithAVolume) {
    EXPECT_EQ(ray_key(from(vec3(3)), {vec3(3), vec3(3)}), 0u);
    EXPECT_EQ(ray_key(from(vec3(3, 3, cells)), {vec3(3, 3, 0), vec3(3, 3, cells)}) >> 3, 0x9249u & (LAST_RAY_KEY >> 3));
    EXPECT_EQ(ray_key(from(vec3(3e38f)), {vec3(-3e38f), vec3(3e38f)}), 0u) << "an extent beyond the largest float";
}

TEST(RayKey, TheBoxComesFromItsBits) {
    const vec3 lo(-3, 0, 1e-30f), hi(-2, 5, 1e30f);
    const WorldBoundBits bits{uvec3(ordered_bits(lo.x), ordered_bits(lo.y), ordered_bits(lo.z)),
                              uvec3(ordered_bits(hi.x), ordered_bits(hi.y), ordered_bits(hi.z)), 0, 0};
    EXPECT_EQ(box_of(bits).lo, lo);
    EXPECT_EQ(box_of(bits).hi, hi);
}

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
