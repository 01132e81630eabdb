// SPDX-License-Identifier: MIT
#include "report/reproducer/short_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinray::reproducer {
namespace {

TEST(ShortNumbers, LengthOrdersThemAsAReaderWould) {
    EXPECT_EQ(length_of(0), 0);
    EXPECT_EQ(length_of(INFINITY), 0);
    EXPECT_LT(length_of(0), length_of(1));
    EXPECT_EQ(length_of(1), length_of(2));
    EXPECT_LT(length_of(1), length_of(-1));
    EXPECT_LT(length_of(4), length_of(3));
    EXPECT_LT(length_of(3), length_of(0.1f));
    EXPECT_LT(length_of(1), length_of(0x1p-60f));
}

TEST(ShortNumbers, AreShorterTheShortestFirstAndNear) {
    for (const float value : {0.1f, -7.3f, 123456.7f, 1e-30f, -3e38f, std::numeric_limits<float>::denorm_min() * 5}) {
        const std::vector<float> shorter = shorter_numbers(value);
        ASSERT_FALSE(shorter.empty()) << value;
        EXPECT_EQ(shorter.front(), 0);
        EXPECT_TRUE(std::ranges::is_sorted(shorter, {}, length_of)) << value;
        for (const float candidate : shorter) {
            EXPECT_TRUE(std::isfinite(candidate)) << value;
            EXPECT_LT(length_of(candidate), length_of(value)) << value << " -> " << candidate;
        }
        // The nearest of them has nearly as many bits, but of denormals, whose bits are few.
        const auto nearest = std::ranges::min(shorter, {}, [&](float c) { return std::abs(c - value); });
        const bool is_denormal = std::abs(value) < std::numeric_limits<float>::min();
        EXPECT_TRUE(is_denormal || std::abs(nearest - value) <= std::abs(value) * 0x1p-18f) << value;
    }
    EXPECT_EQ(shorter_numbers(3.0009f)[1], 4);
    EXPECT_EQ(std::ranges::count(shorter_numbers(3.0009f), 3), 1);
}

TEST(ShortNumbers, NothingIsShorterThanZeroAndNoEnd) {
    EXPECT_TRUE(shorter_numbers(0).empty());
    EXPECT_TRUE(shorter_numbers(INFINITY).empty());
    EXPECT_TRUE(shorter_numbers(NAN).empty());
    EXPECT_EQ(shorter_numbers(1), std::vector<float>{0});
}

}  // namespace
}  // namespace twinray::reproducer
