// Steps of a traversal: the children of a node that a ray enters, the entries on its stack, and leaves of two
// triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <twinray/geometry.h>
#include "engine/accel/geometry.h"
#include "swtlas/structures.h"
#include "validation/cpu_reference/reference.h"
#include "validation/reference/aimed_rays.h"

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

// A ray that ends at a corner of a box meets nothing else of it, whether it begins in the grid, beside it or far away.
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

ChildKeys keys_of(std::vector<uint> children) {
    children.resize(4, NO_ENTRY);
    return {children[0], children[1], children[2], children[3]};
}

std::vector<uint> visited(uint group) {
    std::vector<uint> records;
    for (; group != EMPTY_NODE_GROUP; group = rest_of(group)) records.push_back(next_of(group));
    return records;
}

TEST(Groups, HoldAllChildrenButTheFirstInOrder) {
    for (const uint siblings : {1u, 3u, (1u << 25) + 5, MOST_RECORDS - 4}) {
        EXPECT_EQ(visited(node_group_of(keys_of({2, 0}), siblings)), std::vector{siblings});
        EXPECT_EQ(visited(node_group_of(keys_of({1, 3, 0}), siblings)), (std::vector{siblings + 3, siblings}));
        EXPECT_EQ(visited(node_group_of(keys_of({3, 2, 1, 0}), siblings)),
                  (std::vector{siblings + 2, siblings + 1, siblings}));
        EXPECT_EQ(visited(node_group_of(keys_of({0, 3, 1, 2}), siblings)),
                  (std::vector{siblings + 3, siblings + 1, siblings + 2}));
    }
}

TEST(Groups, AreNoneOfTheOtherEntriesOfAStack) {
    EXPECT_EQ(node_group_of(keys_of({2}), 1), EMPTY_NODE_GROUP);
    for (uint order = 0; order < 64; ++order) {
        const uint group = make_node_group(1, order & 3, order >> 2 & 3, order >> 4);
        for (const uint other : {EMPTY_NODE_GROUP, LEAVE_INSTANCE}) EXPECT_NE(group, other);
    }
    for (const uint side : {0u, 1u})
        for (const uint other : {EMPTY_NODE_GROUP, LEAVE_INSTANCE}) EXPECT_NE(make_edge(0, side), other);
}

// These are the groups left to visit after a traversal went on to a child, whatever it has found since.
TEST(Groups, AreFoundAgainFromTheChild) {
    const ChildKeys keys{0x400, 0x101, NO_ENTRY | 2, 0x203};
    const auto again = [&](uint child) {
        ChildKeys found = keys_from(keys, child);
        sort_keys(found);
        EXPECT_EQ(found.key0 & 3, child);
        EXPECT_LT(found.key0, NO_ENTRY);
        return visited(node_group_of(found, 8));
    };
    EXPECT_EQ(again(1), (std::vector<uint>{8 + 3, 8 + 0}));
    EXPECT_EQ(again(3), std::vector<uint>{8 + 0});
    EXPECT_EQ(again(0), std::vector<uint>{});
    EXPECT_EQ(again(2), std::vector<uint>{}) << "beyond what was found";
}

class ShortStacks : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Of, ShortStacks, testing::Bool(),
                         [](const auto& has) { return has.param ? "two_words" : "one_word"; });

TEST_P(ShortStacks, KeepTheLastEntriesAndSayThatTheyHaveLostOthers) {
    const bool has_two_words = GetParam();
    std::mt19937 random(5);
    ShortStack stack = empty_stack(false);
    std::vector<uint> all;
    std::size_t losses = 0;
    for (int turn = 0; turn < 100'000; ++turn) {
        const bool is_growing = turn / 300 % 2 == 0;
        if (random() % 8 < (is_growing ? 6u : 1u)) {
            all.push_back(static_cast<uint>(random()) | 1);
            push_entry(stack, all.back(), ~all.back(), has_two_words);
        } else if (fetch_last(stack, has_two_words); stack.last != NO_STACK_ENTRY) {
            ASSERT_EQ(stack.last, all.back()) << turn;
            if (has_two_words) {
                ASSERT_EQ(stack.second, ~all.back()) << turn;
            }
            stack.last = NO_STACK_ENTRY;
            all.pop_back();
        } else {
            ASSERT_EQ(stack.bottom != 0, !all.empty()) << turn;
            losses += stack.bottom != 0;
            all.clear();
            stack = empty_stack(false);
        }
        ASSERT_LE(stack.top - stack.bottom, stack_capacity(has_two_words));
    }
    EXPECT_GT(losses, 10u);
}

// The leaves of trees over some triangles, and their order.
struct SoupLeaves {
    Geometry geometry{make_soup(500, 4)};
    std::vector<LeafBox> boxes = reference::leaves_triangles(geometry.built_positions(), geometry.triangles);
    reference::Codes codes = reference::morton(boxes, reference::centroids(boxes));
    std::vector<uint> order = reference::sort(codes);
};

class Records : public testing::TestWithParam<uint> {};
INSTANTIATE_TEST_SUITE_P(OfNodesOf, Records, testing::Values(4u, 8u));

// Every record of a tree is found from the root.
TEST_P(Records, TheSlotTowardsARecordLeadsToIt) {
    const SoupLeaves soup;
    const reference::Hierarchy tree = reference::hierarchy(soup.boxes, soup.codes, soup.order, false);
    const std::vector<CompressedRecord> records =
        reference::records_of_triangles(tree, soup.geometry.built_positions(), soup.geometry.triangles, GetParam());
    const auto all = Ref<CompressedRecord>::to(records.data());
    for (uint target = 1; target < records.size(); ++target) {
        if (!is_leaf(records[target]) && children_in(records[target]) == 0) continue;
        uint at = 0;
        for (uint depth = 0; at != target; ++depth) {
            ASSERT_LT(depth, DEEPEST_RECORDS) << target;
            ASSERT_FALSE(is_leaf(records[at])) << target;
            const ChildSlots slots = child_slots(records[at], second_half_of(all, at, records[at]));
            at = child_index(slots, slot_towards(all, slots, target));
        }
    }
}

TEST(Bvh2, EveryEdgeLeadsBackToTheRoot) {
    const SoupLeaves soup;
    const reference::Hierarchy tree =
        reference::linked(reference::hierarchy(soup.boxes, soup.codes, soup.order, true, BuildQuality::high));
    const auto nodes = Ref<BvhNode>::to(tree.nodes.data());
    for (uint node = 0; node < tree.nodes.size(); ++node)
        for (const uint side : {0u, 1u}) {
            uint at = tree.root;
            for (uint depth = 0;; ++depth) {
                ASSERT_LT(depth, DEEPEST_TREE);
                const uint edge = make_edge(at, binary_child_towards(nodes, at, make_edge(node, side)));
                if (edge == make_edge(node, side)) break;
                at = child_at(nodes, edge);
            }
        }
}

TEST(Groups, KeysAreSortedLeastFirst) {
    ChildKeys keys{9, NO_ENTRY | 1, 4, 7};
    sort_keys(keys);
    EXPECT_EQ((std::vector{keys.key0, keys.key1, keys.key2, keys.key3}), (std::vector<uint>{4, 7, 9, NO_ENTRY | 1}));
}

TEST(Groups, ANodeTellsItsFirstChildAndTheirNumber) {
    CompressedRecord node = no_record();
    for (const uint first : {1u, (1u << 25) + 5, MOST_RECORDS - 4}) {
        NodeChildren children{};
        children.count = 4;
        node = encode_node(children, given_order(15, 0), first, 4).first;
        EXPECT_EQ(first_child_of(node), first);
        EXPECT_EQ(children_in(node), 4u);
        EXPECT_FALSE(is_leaf(node));
    }
    EXPECT_LT(Geometry::max_primitives, 1u << 25);  // leaves beside heights: see subtree_info
}

// A leaf of two triangles finds what the tests of each triangle find, to the bit.
struct Pair {
    std::array<vec3, 4> positions;
    std::array<uvec3, 2> triangles;
};

class Pairs {
  public:
    // Vertices of each triangle come in any order. They are small whole numbers, so that rays also meet edges and
    // vertices.
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
