// SPDX-License-Identifier: MIT
#include "report/reproducer/ddmin.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace twinray::reproducer {
namespace {

// Shows a fault where all of `needed` are there; counts questions.
struct Needs {
    Indices needed;
    std::size_t questions = 0;

    bool operator()(const Indices& kept) {
        ++questions;
        EXPECT_TRUE(std::ranges::is_sorted(kept));
        return std::ranges::includes(kept, needed);
    }
};

Indices reduced(std::size_t count, Needs& needs) {
    return ddmin(count, [&](const Indices& kept) { return needs(kept); });
}

TEST(Ddmin, FindsExactlyWhatIsNeeded) {
    for (const Indices& needed : {Indices{0}, Indices{99}, Indices{37}, Indices{0, 99}, Indices{3, 4, 5, 50, 51, 98}}) {
        Needs needs{needed};
        EXPECT_EQ(reduced(100, needs), needed);
    }
}

TEST(Ddmin, OneOfManyTakesTwoQuestionsAHalving) {
    for (const std::size_t where : {0u, 12345u, 65535u}) {
        Needs needs{{where}};
        EXPECT_EQ(reduced(65536, needs), Indices{where});
        EXPECT_LE(needs.questions, 2u * 16u);
    }
}

TEST(Ddmin, TheWorstCaseKeepsToItsBound) {
    Needs needs{Indices(64)};
    for (std::size_t i = 0; i < 64; ++i) needs.needed[i] = i;
    EXPECT_EQ(reduced(64, needs).size(), 64u);
    EXPECT_LE(needs.questions, 64u * 64u + 3u * 64u);
}

TEST(Ddmin, NothingCanBeLeftOutOfWhatComesBack) {
    // Neither monotonic nor of one least answer: an even number of indices, one of which is divisible by 7.
    const auto shows_fault = [](const Indices& kept) {
        return kept.size() % 2 == 0 && std::ranges::any_of(kept, [](std::size_t i) { return i % 7 == 3; });
    };
    const Indices kept = ddmin(90, shows_fault);
    ASSERT_TRUE(shows_fault(kept));
    for (std::size_t left_out = 0; left_out < kept.size(); ++left_out) {
        Indices fewer = kept;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(left_out));
        EXPECT_FALSE(shows_fault(fewer));
    }
    EXPECT_EQ(ddmin(90, shows_fault), kept);
}

TEST(Ddmin, OneOrNoneIsLeftAsItIs) {
    Needs needs{{}};
    EXPECT_EQ(reduced(1, needs), Indices{0});
    EXPECT_EQ(reduced(0, needs), Indices{});
    EXPECT_EQ(needs.questions, 0u);
}

}  // namespace
}  // namespace twinray::reproducer
