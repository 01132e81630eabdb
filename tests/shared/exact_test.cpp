// SPDX-License-Identifier: MIT
// Error-free transformations of float32, against float64, in which products of two of them are exact.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "swtlas/structures.h"

namespace twinray {
namespace {

// All 24 bits in use, or few of them, from 2^-40 to 2^126.
std::vector<float> numbers() {
    std::mt19937 random(5);
    std::vector<float> made = {0.0f, 1.0f, 0x1.fffffep0f, 0x1.ffep0f, 0x1.000002p0f, 0x1.001p63f, 0x1.fffffep126f};
    for (int i = 0; i < 400; ++i) {
        const auto bits = static_cast<uint>(random()) & (i % 3 == 0 ? 0x7ff000u : 0x7fffffu);
        const float mantissa = 1.0f + static_cast<float>(bits) * 0x1p-23f;
        made.push_back(std::ldexp(i % 2 == 0 ? mantissa : -mantissa, static_cast<int>(random() % 167u) - 40));
    }
    return made;
}

TEST(Exact, ErrorsOfProductsAreExactUpToTheEndOfTheRange) {
    std::size_t compared = 0;
    for (const float a : numbers())
        for (const float b : numbers()) {
            const float product = a * b;
            if (!std::isfinite(product)) continue;
            const double exact = double{a} * double{b};
            EXPECT_EQ(double{product} + double{product_error(a, b, product)}, exact) << a << " * " << b;
            ++compared;
        }
    EXPECT_GT(compared, 100000u);
}

TEST(Exact, ErrorsOfWhatOverflowsAreNoNumbers) {
    const float product = 0x1p100f * 0x1p100f;
    EXPECT_FALSE(std::isfinite(product_error(0x1p100f, 0x1p100f, product)));
}

TEST(Exact, BothPartsOfANumberHaveTwelveBits) {
    for (const float x : numbers()) {
        const float high = high_part(x), low = x - high;
        EXPECT_EQ(high + low, x);
        for (const float part : {high, low}) {
            int exponent = 0;
            const float scaled = std::ldexp(std::frexp(part, &exponent), 12);
            EXPECT_EQ(scaled, std::trunc(scaled)) << x;
        }
    }
}

}  // namespace
}  // namespace twinray
