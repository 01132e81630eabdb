// SPDX-License-Identifier: MIT
#include "validation/kernels/kernel_statistics.h"

namespace twinray {
namespace {

std::uint64_t u(std::uint64_t value) { return value; }

TEST(KernelStatistics, RadvsWordsAreMapped) {
    const std::vector<Statistic> told = {{"Driver pipeline hash", u(17073026995690029095u)},
                                         {"SGPRs", u(128)},
                                         {"VGPRs", u(108)},
                                         {"Spilled VGPRs", u(3)},
                                         {"Code size", u(7528)},
                                         {"LDS size", u(4096)},
                                         {"Scratch size", u(19456)},
                                         {"Subgroups per SIMD", u(14)},
                                         {"Instructions", u(1421)},
                                         {"Pre-Sched VGPRs", u(90)}};
    const KernelFigures expected{108, 128, 14, 19456, 4096, 1421, 7528};
    EXPECT_EQ(figures_of(told), expected);
}

TEST(KernelStatistics, OtherDriversWordsAreMapped) {
    const std::vector<Statistic> nvidia = {{"Register Count", u(40)}, {"Binary Size", u(900)}};
    EXPECT_EQ(figures_of(nvidia).vgprs, 40);
    EXPECT_EQ(figures_of(nvidia).code_bytes, 900);
    const std::vector<Statistic> anv = {{"Instruction Count", 70.0}, {"Scratch Memory Size", std::int64_t{0}}};
    EXPECT_EQ(figures_of(anv).instructions, 70);
    EXPECT_EQ(figures_of(anv).scratch_bytes, 0);
}

TEST(KernelStatistics, WhatIsNotToldIsEmpty) {
    EXPECT_EQ(figures_of({}), KernelFigures{});
    const std::vector<Statistic> odd = {{"VGPRs", std::int64_t{-1}}, {"Instructions", double{NAN}}, {"Hash", u(7)}};
    EXPECT_EQ(figures_of(odd), KernelFigures{});
}

}  // namespace
}  // namespace twinray
