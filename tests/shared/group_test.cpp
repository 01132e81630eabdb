// SPDX-License-Identifier: MIT
// The words on the stack of a traversal of records.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "engine/accel/geometry.h"
#include <twinray/geometry.h>
#include "validation/cpu_reference/reference.h"

namespace twinray {
namespace {

ChildKeys entered(std::vector<uint> children) {
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
        EXPECT_EQ(visited(node_group_of(entered({2, 0}), siblings)), std::vector{siblings});
        EXPECT_EQ(visited(node_group_of(entered({1, 3, 0}), siblings)), (std::vector{siblings + 3, siblings}));
        EXPECT_EQ(visited(node_group_of(entered({3, 2, 1, 0}), siblings)),
                  (std::vector{siblings + 2, siblings + 1, siblings}));
        EXPECT_EQ(visited(node_group_of(entered({0, 3, 1, 2}), siblings)),
                  (std::vector{siblings + 3, siblings + 1, siblings + 2}));
    }
}

TEST(Groups, AreNoneOfTheOtherEntriesOfAStack) {
    EXPECT_EQ(node_group_of(entered({2}), 1), EMPTY_NODE_GROUP);
    for (uint order = 0; order < 64; ++order) {
        const uint group = make_node_group(1, order & 3, order >> 2 & 3, order >> 4);
        for (const uint other : {EMPTY_NODE_GROUP, LEAVE_INSTANCE}) EXPECT_NE(group, other);
    }
    for (const uint side : {0u, 1u})
        for (const uint other : {EMPTY_NODE_GROUP, LEAVE_INSTANCE}) EXPECT_NE(make_edge(0, side), other);
}

// What a traversal that went on to a child has left to visit, whatever it has found since.
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

class Records : public testing::TestWithParam<uint> {};
INSTANTIATE_TEST_SUITE_P(OfNodesOf, Records, testing::Values(4u, 8u));

// Every record of a tree is found from the root.
TEST_P(Records, TheSlotTowardsARecordLeadsToIt) {
    const Mesh mesh = make_soup(500, 4);
    const Geometry geometry(mesh);
    const std::vector<LeafBox> boxes = reference::leaves_triangles(geometry.positions, geometry.triangles);
    const reference::Codes codes = reference::morton(boxes, reference::centroids(boxes));
    const reference::Hierarchy tree = reference::hierarchy(boxes, codes, reference::sort(codes), false);
    const std::vector<CompressedRecord> records =
        reference::records_of_triangles(tree, geometry.positions, geometry.triangles, GetParam());
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
    const Mesh mesh = make_soup(500, 4);
    const Geometry geometry(mesh);
    const std::vector<LeafBox> boxes = reference::leaves_triangles(geometry.positions, geometry.triangles);
    const reference::Codes codes = reference::morton(boxes, reference::centroids(boxes));
    const reference::Hierarchy tree =
        reference::linked(reference::hierarchy(boxes, codes, reference::sort(codes), true, BuildQuality::high));
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

}  // namespace
}  // namespace twinray
