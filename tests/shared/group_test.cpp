// SPDX-License-Identifier: MIT
// The words on the stack of a traversal of records.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "engine/accel/geometry.h"
#include "swtlas/structures.h"

namespace twinray {
namespace {

ChildKeys entered(std::vector<uint> children) {
    children.resize(4, NO_ENTRY);
    return {children[0], children[1], children[2], children[3]};
}

std::vector<uint> visited(uint group) {
    std::vector<uint> records;
    for (; group != EMPTY_GROUP; group = rest_of(group)) records.push_back(next_of(group));
    return records;
}

TEST(Groups, HoldAllChildrenButTheFirstInOrder) {
    for (const uint siblings : {1u, 3u, (1u << 25) + 5, MOST_RECORDS - 4}) {
        EXPECT_EQ(visited(group_of(entered({2, 0}), siblings)), std::vector{siblings});
        EXPECT_EQ(visited(group_of(entered({1, 3, 0}), siblings)), (std::vector{siblings + 3, siblings}));
        EXPECT_EQ(visited(group_of(entered({3, 2, 1, 0}), siblings)),
                  (std::vector{siblings + 2, siblings + 1, siblings}));
        EXPECT_EQ(visited(group_of(entered({0, 3, 1, 2}), siblings)),
                  (std::vector{siblings + 3, siblings + 1, siblings + 2}));
    }
}

TEST(Groups, AreNoneOfTheOtherEntriesOfAStack) {
    for (uint order = 0; order < 64; ++order) {
        const uint group = make_group(1, order & 3, order >> 2 & 3, order >> 4);
        for (const uint other : {EMPTY_GROUP, BOTTOM, IN_WINDOW, IN_MEMORY}) EXPECT_NE(group, other);
    }
}

// A stack as traversals have it, of entries one word each.
class Stack {
  public:
    void push(uint entry) { shift(entry); }
    uint pop() {  // takes the next one off the group that it returns; BOTTOM: there is none
        uint group = held_.first;
        TWINRAY_FETCH_GROUP(held_, window_, memory_, height_, group);
        if (group == BOTTOM) return group;
        held_.first = rest_of(group);
        shift(EMPTY_GROUP);
        return group;
    }
    uint height() const { return height_; }
    uint waiting() const { return waiting_; }

  private:
    void shift(uint pushed) {
        TWINRAY_MAKE_ROOM(held_, window_, memory_, height_, pushed);
        waiting_ = waiting_after(held_, pushed, waiting_);
        shift_groups(held_, pushed);
    }

    HeldGroups held_ = hold_none(BOTTOM);
    GroupWindow window_ = empty_window();
    std::array<uint, GROUP_STACK_SIZE> memory_{};
    uint height_ = 0;
    uint waiting_ = 0;
};

TEST(Groups, ComeFromTheStackInTheOrderOfAStack) {
    std::mt19937 random(5);
    Stack stack;
    std::vector<uint> expected;
    std::size_t highest = 0, empty = 0;
    for (int turn = 0; turn < 100'000; ++turn) {
        const bool is_growing = turn / 300 % 2 == 0;
        if (expected.size() < GROUP_STACK_SIZE + WINDOW_SIZE + 5 && random() % 8 < (is_growing ? 6u : 1u)) {
            const auto order = static_cast<uint>(random());
            expected.push_back(make_group(static_cast<uint>(turn) + 1, order & 3, order >> 2 & 3, order >> 4 & 3));
            stack.push(expected.back());
        } else {
            const uint last = expected.empty() ? BOTTOM : expected.back();
            ASSERT_EQ(stack.pop(), last) << turn;
            if (expected.empty())
                ++empty;
            else if ((expected.back() = rest_of(last)) == EMPTY_GROUP)
                expected.pop_back();
        }
        ASSERT_EQ(stack.waiting(), expected.size()) << turn;
        highest = std::max<std::size_t>(highest, stack.height());
    }
    EXPECT_EQ(highest, GROUP_STACK_SIZE);
    EXPECT_GT(empty, 100u);
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
        node = encode_node(children, first);
        EXPECT_EQ(first_child_of(node), first);
        EXPECT_EQ(children_in(node), 4u);
        EXPECT_FALSE(is_leaf(node));
    }
    EXPECT_LT(Geometry::max_primitives, 1u << 25);  // leaves beside heights: see make_below
}

}  // namespace
}  // namespace twinray
