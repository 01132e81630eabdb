// SPDX-License-Identifier: MIT
#include "cli/kernels/kernel_statistics.h"

namespace twinray {
namespace {

std::uint64_t u(std::uint64_t value) { return value; }

TEST(KernelStatistics, RadvsWordsAreMapped) {
    const std::vector<Statistic> told = {{"Driver pipeline hash", u(17073026995690029095u)},
                                         {"SGPRs", u(128)},
                                         {"VGPRs", u(108)},
                                         {"Spilled VGPRs", u(2)},
                                         {"Spilled SGPRs", u(1)},
                                         {"Code size", u(7528)},
                                         {"LDS size", u(4096)},
                                         {"Scratch size", u(19456)},
                                         {"Subgroups per SIMD", u(14)},
                                         {"Instructions", u(1421)},
                                         {"Pre-Sched VGPRs", u(90)}};
    const KernelFigures expected{108, 128, 14, 19456, 4096, 1421, 7528, 3};
    EXPECT_EQ(figures_of(told), expected);
}

// Mesa 26.1 and 26.2 tell them so.
TEST(KernelStatistics, NvksWordsAreMapped) {
    const std::vector<Statistic> told = {{"Instruction count", u(1657)}, {"Static cycle count", u(158327)},
                                         {"Max warps/SM", u(16)},        {"Spills to memory", u(2)},
                                         {"Fills from memory", u(4)},    {"Spills to reg", u(29)},
                                         {"Fills from reg", u(10)},      {"Code size", u(26512)},
                                         {"Number of GPRs", u(104)},     {"SLM size", u(16)}};
    const KernelFigures expected{104, {}, 16, 16, {}, 1657, 26512, 31};
    EXPECT_EQ(figures_of(told), expected);
}

TEST(KernelStatistics, TurnipsWordsAreMapped) {
    const std::vector<Statistic> told = {{"Max Waves Per Core", u(10)},
                                         {"Instruction Count", u(1015)},
                                         {"Code size", u(1536)},
                                         {"NOPs Count", u(278)},
                                         {"Registers used", u(19)},
                                         {"Half-registers used", u(0)},
                                         {"STP Count", u(5)},
                                         {"LDP Count", u(7)},
                                         {"Preamble Instruction Count", u(15)}};
    const KernelFigures expected{19, {}, 10, {}, {}, 1015, 6144, 5};
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
