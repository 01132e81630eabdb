// SPDX-License-Identifier: MIT
#include "validation/reference/bvh64.h"

#include <gtest/gtest.h>

#include <set>

namespace twinray {
namespace {

Box64 box_at(const dvec3& low, double size) {
    Box64 box;
    box.include(low);
    box.include(low + size);
    return box;
}

// The items in the leaves that a ray visits, each expected once.
std::set<uint> visited(const Bvh64& bvh, const dvec3& origin, const dvec3& direction) {
    std::set<uint> items;
    const double no_limit = INFINITY;
    bvh.visit_leaves(SlabRay(origin, direction, 0), 0, no_limit, [&](uint first, uint last) {
        EXPECT_LE(last - first, 4u);
        for (uint i = first; i < last; ++i) EXPECT_TRUE(items.insert(bvh.order()[i]).second) << i;
        return true;
    });
    return items;
}

TEST(Bvh64, RayThroughAllBoxesVisitsEachItemOnce) {
    std::vector<Box64> boxes;
    for (int i = 0; i < 1000; ++i) boxes.push_back(box_at({i * 7 % 1000, 0, 0}, 0.5));
    const Bvh64 bvh(boxes);
    EXPECT_EQ(visited(bvh, {-1, 0.25, 0.25}, {1, 0, 0}).size(), 1000u);
    EXPECT_EQ(visited(bvh, {2000, 0.25, 0.25}, {-1, -0.0, 0}).size(), 1000u);
    EXPECT_EQ(visited(bvh, {-1, 0.75, 0.25}, {1, 0, 0}).size(), 0u);
    EXPECT_LT(visited(bvh, {500, -1, 0.25}, {0, 1, 0}).size(), 9u);
}

TEST(Bvh64, DepthIsBoundedForSizesThatHalveAThousandTimes) {
    std::vector<Box64> boxes;
    for (int i = -500; i < 500; ++i) boxes.push_back(box_at({std::ldexp(1.0, i), 0, 0}, std::ldexp(0.5, i)));
    const Bvh64 bvh(boxes);
    EXPECT_EQ(visited(bvh, {-1, 0, 0}, {1, 0, 0}).size(), 1000u);
    EXPECT_EQ(visited(bvh, {std::ldexp(1.0, 510), 0, 0}, {-1, 0, 0}).size(), 1000u);
}

TEST(Bvh64, EqualBoxesAreSplitByHalves) {
    const std::vector<Box64> boxes(1000, box_at({1, 2, 3}, 1));
    EXPECT_EQ(visited(Bvh64(boxes), {0, 2.5, 3.5}, {1, 0, 0}).size(), 1000u);
}

TEST(Bvh64, OfNothingIsNeverVisited) {
    EXPECT_TRUE(visited(Bvh64(std::span<const Box64>()), {0, 0, 0}, {1, 0, 0}).empty());
    EXPECT_TRUE(visited(Bvh64(), {0, 0, 0}, {1, 0, 0}).empty());
    EXPECT_TRUE(Bvh64().bounds().is_empty());
}

TEST(SlabRay, IntervalOfABoxContainsThatOfEveryBoxInside) {
    const Box64 outer = box_at({-1, -1, -1}, 2);
    for (int i = 0; i < 2000; ++i) {
        const auto fraction = [&](int k) { return std::fmod(i * 0.618033988749895 * k, 1.0); };
        const Box64 inner = box_at({-fraction(1), -fraction(2), fraction(3) - 1}, fraction(4));
        const dvec3 origin(fraction(5) * 5 - 2.5, fraction(6) * 5 - 2.5, i % 3 == 0 ? -1 : fraction(7));
        const dvec3 direction(fraction(8) - 0.5, i % 2 == 0 ? 0.0 : fraction(9) - 0.5, i % 3 == 0 ? -0.0 : 0.1);
        const SlabRay ray(origin, direction, 0);
        const Interval64 wide = ray.clip(outer), narrow = ray.clip(inner);
        ASSERT_LE(wide.near, narrow.near) << i;
        ASSERT_GE(wide.far, narrow.far) << i;
    }
}

TEST(SlabRay, ZeroComponentsOfEitherSignAcceptRaysOnAndBetweenThePlanes) {
    const Box64 box = box_at({0, 0, 0}, 1);
    for (const double zero : {0.0, -0.0}) {
        for (const double y : {0.0, 0.5, 1.0}) {
            const Interval64 t = SlabRay({-2, y, 0.5}, {1, zero, zero}, 0).clip(box);
            EXPECT_EQ(t.near, 2) << y;
            EXPECT_EQ(t.far, 3) << y;
        }
        for (const double y : {-0.5, 1.5}) EXPECT_TRUE(SlabRay({-2, y, 0.5}, {1, zero, zero}, 0).clip(box).is_empty());
    }
}

TEST(SlabRay, PadGrowsTheBoxOnEverySide) {
    const Box64 box = box_at({0, 0, 0}, 1);
    for (const double sign : {1.0, -1.0}) {
        const Interval64 t = SlabRay({0.5 - 2.5 * sign, 1.25, -0.25}, {sign, 0, 0}, 0.25).clip(box);
        EXPECT_EQ(t.near, 1.75);
        EXPECT_EQ(t.far, 3.25);
    }
}

}  // namespace
}  // namespace twinray
