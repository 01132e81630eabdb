// SPDX-License-Identifier: MIT
// A leaf of two triangles finds what the tests of each triangle find, to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "swtlas/structures.h"

namespace twinray {
namespace {

struct Pair {
    std::array<vec3, 4> positions;
    std::array<uvec3, 2> triangles;
};

class Pairs {
  public:
    // Vertices of each triangle come in any order. They are small whole numbers, so that rays meet edges and vertices,
    // too.
    Pair next() {
        Pair made{};
        for (vec3& position : made.positions) position = point();
        std::array<uint, 3> first = {0, 1, 2}, second = {1, 2, 3};
        std::ranges::shuffle(first, random_);
        std::ranges::shuffle(second, random_);
        made.triangles = {uvec3(first[0], first[1], first[2]), uvec3(second[0], second[1], second[2])};
        return made;
    }
    RaySpace ray() {
        vec3 direction(0);
        while (direction == vec3(0)) direction = point();
        return make_ray_space(point() * 3.0f, direction, 0);
    }

  private:
    vec3 point() { return vec3(number_(random_), number_(random_), number_(random_)); }

    std::mt19937 random_{5};
    std::uniform_int_distribution<int> number_{-3, 3};
};

LeafVertices vertices_of(const Pair& pair) {
    BuildTree tree{};
    tree.indices = Uints::to(&pair.triangles[0].x);
    return vertices_of_leaf(encode_pair(tree, make_leaf(0, 1), 3), Floats::to(&pair.positions[0].x));
}

BvhTriangle triangle_of(const Pair& pair, uint i) {
    const uvec3 t = pair.triangles[i];
    return {pair.positions[t.x], pair.positions[t.y], pair.positions[t.z], i};
}

bool is_met(const BvhTriangle& t, const RaySpace& space, uint level, TriangleHit& hit) {
    if (level == LEVEL_FAST) return intersect_triangle_fast(t.v0, t.v1, t.v2, space, hit);
    uint sign_of_t = SIGN_UNASKED;
    return intersect_triangle(t.v0, t.v1, t.v2, space, sign_of_t, hit) || is_sign_asked(sign_of_t);
}

bool is_seen_as(const SeenTriangle& a, const SeenTriangle& b) {
    return a.a == b.a && a.b == b.b && a.c == b.c && a.area_a == b.area_a && a.area_b == b.area_b &&
           a.area_c == b.area_c;
}

TEST(LeafVisits, FindWhatTestsOfEachTriangleFind) {
    Pairs pairs;
    std::size_t met[3] = {}, faults = 0, missed = 0;
    for (int round = 0; round < 300'000; ++round) {
        const Pair pair = pairs.next();
        const RaySpace space = pairs.ray();
        const LeafVertices vertices = vertices_of(pair);
        for (const uint level : {LEVEL_FAST, LEVEL_WATERTIGHT}) {
            std::array<bool, 2> is_visited{}, is_right{};
            LeafVisit visit{};
            for (const bool comes_second : {false, true}) {
                if (comes_second && !visit.is_followed) break;
                visit = visit_in_leaf(vertices, comes_second, false, space, 0, level);
                missed += visit.is_missed;
                if (visit.is_missed) break;
                const BvhTriangle t = triangle_of(pair, visit.is_second);
                is_visited[visit.is_second] = true;
                faults += level == LEVEL_FAST
                              ? visit.primitive.v0 != t.v0 || visit.primitive.v1 != t.v1 || visit.primitive.v2 != t.v2
                              : !is_seen_as(visit.seen, seen_triangle(t.v0, t.v1, t.v2, space));
            }
            uint both = 0;
            for (uint i = 0; i < 2; ++i) {
                TriangleHit hit{};
                is_right[i] = is_met(triangle_of(pair, i), space, level, hit);
                both += is_right[i];
                faults += is_right[i] && !is_visited[i];
            }
            ++met[both];
        }
    }
    EXPECT_EQ(faults, 0u);
    EXPECT_GT(missed, 200'000u);
    for (const std::size_t count : met) EXPECT_GT(count, 3'000u) << "neither, one and both are met";
}

}  // namespace
}  // namespace twinray
