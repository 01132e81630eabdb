// SPDX-License-Identifier: MIT
// Numbers of 16 bits, all of them, against float64.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "engine/accel/mesh_gather.h"

namespace twinray {
namespace {

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
