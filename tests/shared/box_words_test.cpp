// SPDX-License-Identifier: MIT
// Boxes that are read and written as words are the floats that they hold.
#include <cmath>
#include <cstring>
#include <vector>

#include "swtlas/structures.h"

#include <gtest/gtest.h>

namespace twinray {
namespace {

TEST(BoxWords, AreTheFloatsOfTheBox) {
    const LeafBox boxes[] = {{vec3(1, -2, 3), vec3(4, 5, -6)},
                             empty_box(),
                             {vec3(-0.0f, 1e-45f, 3.4e38f), vec3(0.0f, -1e-45f, std::nanf("7"))}};
    std::vector<LeafBox> stored(5, {vec3(7), vec3(8)});
    const std::vector<LeafBox> before = stored;
    for (uint i = 0; i < 3; ++i) store_box(Ref<LeafBox>::to(stored.data()), i + 1, boxes[i]);
    EXPECT_EQ(std::memcmp(&stored[1], boxes, sizeof boxes), 0);
    EXPECT_EQ(std::memcmp(&stored[0], &before[0], sizeof(LeafBox)), 0) << "the one before is as it was";
    EXPECT_EQ(std::memcmp(&stored[4], &before[4], sizeof(LeafBox)), 0) << "and the one behind";
    for (uint i = 0; i < 3; ++i) {
        const LeafBox loaded = load_box(Ref<LeafBox>::to(stored.data()), i + 1);
        EXPECT_EQ(std::memcmp(&loaded, &boxes[i], sizeof loaded), 0) << i;
    }
}

}  // namespace
}  // namespace twinray
