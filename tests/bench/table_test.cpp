// SPDX-License-Identifier: MIT
#include "bench/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace twinray::bench {
namespace {

TEST(BenchTable, ColumnsAreAsWideAsTheirWidestCell) {
    std::ostringstream out;
    print_table(out, {{"name", "ms"}, {"a", "12.5"}});
    EXPECT_EQ(out.str(), "  name    ms\n  a     12.5\n");
}

TEST(BenchTable, NumbersKeepTheirDigits) {
    EXPECT_EQ(number_text(1234.4, 3), "1234");
    EXPECT_EQ(number_text(12.345, 3), "12.3");
    EXPECT_EQ(number_text(0.0012345, 3), "0.00123");
    EXPECT_EQ(number_text(0, 3), "0.00");
    EXPECT_EQ(number_text(-2, 2), "-2.0");
    EXPECT_EQ(number_text(NAN, 3), "-");
}

}  // namespace
}  // namespace twinray::bench
