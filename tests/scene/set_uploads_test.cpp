// SPDX-License-Identifier: MIT
#include "engine/scene/set_uploads.h"

#include <gtest/gtest.h>

namespace twinray {
namespace {

TEST(SetUploads, NeighboursAreUploadedAsOneRegion) {
    EXPECT_EQ(runs_of({}), std::vector<ElementRun>{});
    EXPECT_EQ(runs_of({5}), (std::vector<ElementRun>{{5, 6}}));
    EXPECT_EQ(runs_of({7, 3, 4, 9, 8, 1}), (std::vector<ElementRun>{{1, 2}, {3, 5}, {7, 10}}));
}

TEST(SetUploads, ArraysGrowByDoublingAndNeverShrink) {
    EXPECT_EQ(grown_capacity(0, 0), 0u);
    EXPECT_EQ(grown_capacity(1, 0), 16u);
    EXPECT_EQ(grown_capacity(16, 16), 16u);
    EXPECT_EQ(grown_capacity(17, 16), 32u);
    EXPECT_EQ(grown_capacity(1000, 16), 1000u);
    EXPECT_EQ(grown_capacity(3, 1000), 1000u);
}

}  // namespace
}  // namespace twinray
