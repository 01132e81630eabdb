// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/accel/ray_sort.h"

namespace twinray {
namespace {

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

}  // namespace
}  // namespace twinray
