// SPDX-License-Identifier: MIT
// Three words in two fetches are the three, wherever they begin.
#include <cstring>
#include <vector>

#include "swtlas/structures.h"

#include <gtest/gtest.h>

namespace twinray {
namespace {

TEST(LoadThree, OfPositionsAndIndices) {
    const std::vector<float> positions = {0.0f, -1.5f, 2.0f, 3.25f, -0.0f, 1e-45f, 6.0f, 7.0f, 8.0f};
    for (uint vertex = 0; vertex < 3; ++vertex) {
        const vec3 loaded = load_position(Floats::to(positions.data()), vertex);
        EXPECT_EQ(std::memcmp(&loaded, &positions[std::size_t{3} * vertex], sizeof loaded), 0) << vertex;
    }
    const std::vector<uint> indices = {1, 2, 3, 40, 50, 60, 7, 8, 9};
    EXPECT_EQ(load_indices(Uints::to(indices.data()), 1), uvec3(40, 50, 60));
    EXPECT_EQ(load_indices(Uints::to(indices.data()), 2), uvec3(7, 8, 9));
}

}  // namespace
}  // namespace twinray
