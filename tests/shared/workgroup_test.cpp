// SPDX-License-Identifier: MIT
// How groups are dealt out to the threads of a CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "engine/accel/trace_args.h"

namespace twinray {
namespace {

std::vector<uint> dealt(uint count, uint hands) {
    std::vector<uint> groups(count);
    for (uint i = 0; i < count; ++i) groups[i] = dealt_group(i, count, hands);
    return groups;
}

std::vector<uint> in_order(uint count) {
    std::vector<uint> groups(count);
    std::iota(groups.begin(), groups.end(), 0u);
    return groups;
}

TEST(DealtGroups, AreAllOfThemOnce) {
    for (const uint hands : {0u, 1u, 2u, 3u, 16u, 64u})
        for (const uint count : {1u, 2u, 3u, 15u, 16u, 17u, 64u, 1000u, 16'384u}) {
            std::vector<uint> groups = dealt(count, hands);
            std::sort(groups.begin(), groups.end());
            EXPECT_EQ(groups, in_order(count)) << count << " to " << hands;
        }
}

TEST(DealtGroups, GoToEachStretchInTurn) {
    EXPECT_EQ(dealt(11, 3), (std::vector<uint>{0, 3, 6, 1, 4, 7, 2, 5, 8, 9, 10}));
    EXPECT_EQ(dealt(8, 2), (std::vector<uint>{0, 2, 4, 6, 1, 3, 5, 7}));
}

TEST(DealtGroups, StayWithoutTwoHandsAndWhereGroupsAreFewer) {
    EXPECT_EQ(dealt(1000, 0), in_order(1000));
    EXPECT_EQ(dealt(1000, 1), in_order(1000));
    EXPECT_EQ(dealt(5, 16), in_order(5));
}

}  // namespace
}  // namespace twinray
