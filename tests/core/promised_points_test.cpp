// SPDX-License-Identifier: MIT
// In which order points of commands that are not submitted yet may pass.
#include <gtest/gtest.h>

#include "engine/core/promised_points.h"

namespace twinray {
namespace {

TEST(PromisedPoints, PassInTheOrderInWhichTheyWerePromised) {
    PromisedPoints points;
    EXPECT_EQ(points.promise(), 1u);
    EXPECT_EQ(points.promise(), 2u);
    EXPECT_TRUE(points.is_due(1));
    EXPECT_FALSE(points.is_due(2));
    points.pass(1);
    EXPECT_TRUE(points.is_passed(1) && points.is_due(2));
}

TEST(PromisedPoints, ThoseGivenUpPassWithTheOneBefore) {
    PromisedPoints points;
    for (int i = 0; i < 4; ++i) points.promise();
    points.give_up(3);
    points.give_up(2);
    EXPECT_EQ(points.value_of(1), 3u);
    points.pass(1);
    EXPECT_EQ(points.last_passed(), 3u);
    EXPECT_EQ(points.value_of(4), 4u);
    EXPECT_TRUE(points.is_due(4));
}

}  // namespace
}  // namespace twinray
