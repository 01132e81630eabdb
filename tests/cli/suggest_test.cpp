// SPDX-License-Identifier: MIT
#include "cli/command/suggest.h"

#include <gtest/gtest.h>

#include <vector>

namespace twinray::cli {
namespace {

TEST(Suggest, DistanceCountsLettersThatDiffer) {
    EXPECT_EQ(edit_distance("", ""), 0u);
    EXPECT_EQ(edit_distance("trace", "trace"), 0u);
    EXPECT_EQ(edit_distance("", "abc"), 3u);
    EXPECT_EQ(edit_distance("trce", "trace"), 1u);
    EXPECT_EQ(edit_distance("traces", "trace"), 1u);
    EXPECT_EQ(edit_distance("trake", "trace"), 1u);
    EXPECT_EQ(edit_distance("tarce", "trace"), 1u) << "neighbours swapped";
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Suggest, TheNearestIsOnlyNamedWhereItIsNear) {
    const std::vector<std::string> commands = {"trace", "verify", "leaks", "bench"};
    EXPECT_EQ(nearest_to("trase", commands), "trace");
    EXPECT_EQ(nearest_to("verfy", commands), "verify");
    EXPECT_EQ(nearest_to("leak", commands), "leaks");
    EXPECT_EQ(nearest_to("ver", commands), "verify") << "begun";
    EXPECT_EQ(nearest_to("v", commands), "");
    EXPECT_EQ(nearest_to("frob", commands), "");
    EXPECT_EQ(nearest_to("x", {}), "");
}

}  // namespace
}  // namespace twinray::cli
