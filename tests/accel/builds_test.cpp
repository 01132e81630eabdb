// SPDX-License-Identifier: MIT
// Builds that a sync makes: which changes refit a top level and which rebuild it, and how many share a batch.
#include "engine/accel/batches.h"
#include "engine/accel/scene_update.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace twinray {
namespace {

constexpr SceneChange moved_again{.is_built = true, .was_moved = true, .built_count = 3, .count = 3};

SceneChange with(const std::function<void(SceneChange&)>& change) {
    SceneChange changed = moved_again;
    change(changed);
    return changed;
}

TEST(SceneUpdate, WhatOnlyMovedAgainIsRefitted) { EXPECT_FALSE(must_build(moved_again)); }

TEST(SceneUpdate, AnotherNumberOfInstancesRebuilds) {
    for (const std::size_t count : {0, 2, 4})
        EXPECT_TRUE(must_build(with([&](SceneChange& change) { change.count = count; }))) << count;
}

TEST(SceneUpdate, SoDoesAllElse) {
    EXPECT_TRUE(must_build({})) << "the first time";
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.was_moved = false; }))) << "the first move";
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.has_structure = true; })));
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.has_new_geometry = true; })));
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.has_degraded = true; })));
}

std::vector<std::size_t> counts_of(const std::vector<std::uint64_t>& bytes, std::uint64_t budget) {
    std::vector<std::size_t> counts;
    for (const Batches::Run& run : cut_into_batches(bytes, budget).runs) counts.push_back(run.count);
    return counts;
}

TEST(Batches, FillTheBudgetAndNoMore) {
    using Counts = std::vector<std::size_t>;
    EXPECT_EQ(counts_of({}, 10), Counts{});
    EXPECT_EQ(counts_of({4, 6}, 10), Counts{2});
    EXPECT_EQ(counts_of({4, 7}, 10), (Counts{1, 1}));
    EXPECT_EQ(counts_of({4, 6, 1, 9, 1}, 10), (Counts{2, 2, 1}));
    EXPECT_EQ(counts_of({1, 1, 1}, 0), (Counts{1, 1, 1}));
    EXPECT_EQ(counts_of({0, 0, 0}, 0), Counts{3});
    EXPECT_EQ(counts_of({3, 50, 3, 3}, 10), (Counts{1, 1, 2})) << "one that exceeds the budget goes alone";
    EXPECT_EQ(counts_of({UINT64_MAX, 1, 2}, UINT64_MAX), (Counts{1, 2}));
}

TEST(Batches, CoverEveryBuildOnceInOrder) {
    std::mt19937 random(1);
    for (int round = 0; round < 200; ++round) {
        std::vector<std::uint64_t> bytes(random() % 50);
        for (std::uint64_t& b : bytes) b = random() % 100;
        const std::uint64_t budget = random() % 200;
        const Batches batches = cut_into_batches(bytes, budget);
        std::size_t next = 0;
        std::uint64_t largest = 0;
        for (const Batches::Run& run : batches.runs) {
            ASSERT_EQ(run.first, next);
            ASSERT_GT(run.count, 0u);
            std::uint64_t sum = 0;
            for (std::size_t i = 0; i < run.count; ++i) sum += bytes[next++];
            EXPECT_TRUE(sum <= budget || run.count == 1);
            EXPECT_TRUE(next == bytes.size() || sum + bytes[next] > budget) << "another would have fitted";
            largest = std::max(largest, sum);
        }
        EXPECT_EQ(next, bytes.size());
        EXPECT_EQ(batches.scratch_bytes, largest);
    }
}

}  // namespace
}  // namespace twinray
