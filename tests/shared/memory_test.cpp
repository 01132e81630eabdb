// SPDX-License-Identifier: MIT
// Memory as kernels read and write it, in words: positions and indices, boxes, and numbers of 16 bits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "engine/accel/mesh_gather.h"
#include "swtlas/structures.h"

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

// Returns the value of a number of 16 bits in float64.
double half_value(uint bits) {
    const double sign = bits & 0x8000u ? -1 : 1;
    const int exponent = static_cast<int>(bits >> 10 & 31u);
    const double fraction = bits & 1023u;
    if (exponent == 31) return fraction != 0 ? NAN : sign * INFINITY;
    return sign * (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25));
}

TEST(GatherMesh, EveryHalfIsItsValue) {
    for (uint bits = 0; bits < 65536; ++bits) {
        const double value = half_value(bits);
        const float decoded = float_of_half(bits);
        if (std::isnan(value)) {
            EXPECT_TRUE(std::isnan(decoded)) << bits;
            continue;
        }
        EXPECT_EQ(double(decoded), value) << bits;
        EXPECT_EQ(std::signbit(decoded), std::signbit(value)) << bits;
    }
}

TEST(GatherMesh, EveryNormalizedNumberIsItsQuotientRoundedOnce) {
    for (int value = -32768; value < 32768; ++value)
        EXPECT_EQ(float_of_snorm16(static_cast<uint>(value) & 0xffffu),
                  value == -32768 ? -1.0f : static_cast<float>(value / 32767.0))
            << value;
}

}  // namespace
}  // namespace twinray
