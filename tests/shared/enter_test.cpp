// SPDX-License-Identifier: MIT
// Which children of a node of layout compressed4 a ray enters.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include "validation/reference/draws.h"
#include "swtlas/structures.h"

namespace twinray {
namespace {

std::array<bool, 4> entered(const NodeChildren& children, const Ray& ray, float extent) {
    const BoxRay prepared = box_ray(make_ray_space(ray.origin, ray.direction, vertex_pad(ray.origin, extent)));
    const NodeRecords node = encode_node(children, given_order((1u << children.count) - 1, 0), 1, 4);
    const ChildKeys keys = enter_compressed(node.first, prepared, ray.t_min, ray.t_max, QUERY_CLOSEST);
    return {keys.key0 < NO_ENTRY, keys.key1 < NO_ENTRY, keys.key2 < NO_ENTRY, keys.key3 < NO_ENTRY};
}

vec3 point_between(Draws& draws, vec3 lo, vec3 hi) {
    return vec3(draws.between(lo.x, hi.x), draws.between(lo.y, hi.y), draws.between(lo.z, hi.z));
}

// From far away the padding of a ray is wider than the grid of a node: all boxes in it are crossed.
TEST(Enter, ARayFromAfarEntersTheChildrenThatAreThereAndNoOther) {
    for (uint count = 2; count <= 4; ++count) {
        NodeChildren children{};
        children.count = count;
        for (uint i = 0; i < count; ++i) children.box[i] = {vec3(0.2f * float(i)), vec3(0.2f * float(i) + 0.1f)};
        const Ray ray{vec3(-1e7f, 0.5f, 0.5f), 0.0f, vec3(1.0f, 0.0f, 0.0f), INFINITY};
        const std::array<bool, 4> found = entered(children, ray, 1.0f);
        for (uint i = 0; i < 4; ++i) EXPECT_EQ(found[i], i < count) << i << " of " << count;
    }
}

// Rays that end at a corner of a box meet nothing else of it, whether they begin in the grid, beside it or far away.
TEST(Enter, ARayToACornerOfABoxEntersIt) {
    Draws draws(11, 0);
    for (int turn = 0; turn < 200'000; ++turn) {
        const auto size = static_cast<float>(std::exp2(draws.between(-20, 20)));
        const vec3 middle =
            point_between(draws, vec3(-1), vec3(1)) * size * static_cast<float>(std::exp2(draws.between(-3, 10)));
        NodeChildren children{};
        children.count = 4;
        for (LeafBox& box : children.box) {
            const vec3 a = middle + point_between(draws, vec3(-size), vec3(size));
            const vec3 b = middle + point_between(draws, vec3(-size), vec3(size));
            box = {min(a, b), max(a, b)};
        }
        const auto aim = static_cast<uint>(turn) % 4;
        const LeafBox& box = children.box[aim];
        const vec3 corner(draws.between(0, 1) < 0.5 ? box.lo.x : box.hi.x,
                          draws.between(0, 1) < 0.5 ? box.lo.y : box.hi.y,
                          draws.between(0, 1) < 0.5 ? box.lo.z : box.hi.z);
        const vec3 away =
            point_between(draws, vec3(-1), vec3(1)) * size * static_cast<float>(std::exp2(draws.between(-8, 8)));
        const Ray ray{corner + away, 0.0f, -away, 2.0f};
        const LeafBox around = box_around(children, 4);
        ASSERT_TRUE(entered(children, ray, largest_coordinate(around.lo, around.hi))[aim]) << turn;
    }
}

}  // namespace
}  // namespace twinray
