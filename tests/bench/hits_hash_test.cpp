// SPDX-License-Identifier: MIT
#include "bench/hits_hash.h"

#include <gtest/gtest.h>

#include <cmath>

namespace twinray::bench {
namespace {

std::vector<Hit> two_hits() { return {{1, 2, 3, 4, 0.25f, 0.5f, 7, 0}, miss()}; }

std::uint64_t closest(const std::vector<Hit>& hits) { return hash_of(hits, Query::closest); }
std::uint64_t any(const std::vector<Hit>& hits) { return hash_of(hits, Query::any); }

TEST(HitsHash, IsFnv1a) {
    EXPECT_EQ(closest({}), 0xcbf29ce484222325u);  // its offset basis
    // Of the bytes 01 00 00 00, from its definition.
    std::uint64_t expected = 0xcbf29ce484222325u;
    for (const std::uint64_t byte : {1u, 0u, 0u, 0u}) expected = (expected ^ byte) * 0x100000001b3u;
    EXPECT_EQ(any({{1, 2, 3, 4, 0.25f, 0.5f, 7, 0}}), expected);
    EXPECT_EQ(hexadecimal(0xcbf29ce484222325u), "cbf29ce484222325");
    EXPECT_EQ(hexadecimal(0x1f), "000000000000001f");
}

TEST(HitsHash, SeesTheOrder) {
    std::vector<Hit> swapped = two_hits();
    std::swap(swapped[0], swapped[1]);
    EXPECT_NE(closest(swapped), closest(two_hits()));
    EXPECT_NE(any(swapped), any(two_hits()));
}

TEST(HitsHash, SeesTheLastBitOfEachFieldThatCounts) {
    const auto changed = [](auto change) {
        std::vector<Hit> hits = two_hits();
        change(hits[0]);
        return closest(hits) != closest(two_hits());
    };
    EXPECT_TRUE(changed([](Hit& hit) { hit.hit = 0; }));
    EXPECT_TRUE(changed([](Hit& hit) { ++hit.primitive_index; }));
    EXPECT_TRUE(changed([](Hit& hit) { ++hit.instance_index; }));
    EXPECT_TRUE(changed([](Hit& hit) { hit.t = std::nextafter(hit.t, 9.0f); }));
    EXPECT_TRUE(changed([](Hit& hit) { hit.u = std::nextafter(hit.u, 9.0f); }));
    EXPECT_TRUE(changed([](Hit& hit) { hit.v = std::nextafter(hit.v, 9.0f); }));
    EXPECT_TRUE(changed([](Hit& hit) { std::swap(hit.u, hit.v); }));
    EXPECT_FALSE(changed([](Hit& hit) { ++hit.custom_index; }));
}

TEST(HitsHash, OfAnyHitsCountsHitAlone) {
    std::vector<Hit> hits = two_hits();
    hits[0].t = 9;
    hits[0].primitive_index = 9;
    EXPECT_EQ(any(hits), any(two_hits()));
    hits[1].hit = 1;
    EXPECT_NE(any(hits), any(two_hits()));
}

}  // namespace
}  // namespace twinray::bench
