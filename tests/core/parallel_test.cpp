// SPDX-License-Identifier: MIT
#include "engine/core/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace twinray {
namespace {

TEST(ParallelFor, CoversEachIndexOnceOnAnyNumberOfThreads) {
    for (const unsigned threads : {0u, 1u, 2u, 7u}) {
        std::vector<std::atomic<int>> visits(10007);
        parallel_for(
            visits.size(),
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) ++visits[i];
            },
            threads);
        for (const auto& visit : visits) ASSERT_EQ(visit, 1);
    }
    parallel_for(0, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelFor, ThrowsWhatABodyThrows) {
    const auto body = [](std::size_t begin, std::size_t) {
        if (begin > 500) throw std::runtime_error("late");
    };
    EXPECT_THROW(parallel_for(100000, body, 3), std::runtime_error);
}

}  // namespace
}  // namespace twinray
