#include "engine/core/radix_sort.h"

#include <numeric>

#include "tests/support/device.h"

namespace twinray {
namespace {

class RadixSortTest : public test::VulkanTest {
  protected:
    enum class Groups { from_host, from_device, none_from_device };
    enum class Values { given, places, places_by_own_keys };
    // Values are 0, 1, 2, ... to show stability; if places are meant, the values are others, which must not be read.
    std::vector<uint> sorted_values(const RadixSort& sort, uint threads, const std::vector<uint>& keys, uint bits,
                                    Groups from = Groups::from_host, Values kind = Values::given) {
        const std::uint64_t bytes = keys.size() * sizeof(uint);
        std::vector<uint> values(keys.size());
        std::iota(values.begin(), values.end(), kind == Values::given ? 0u : 7u);
        Buffer buffers[5];
        for (Buffer& buffer : buffers) buffer = Buffer(context(), {.name = "sort test", .bytes = bytes});
        Buffer counters(context(), {.name = "counters", .bytes = RadixSort::counter_bytes(keys.size(), threads)});
        const uint some = from == Groups::none_from_device ? 0u : 1u;
        const uint groups[] = {some * sort.sort_groups(keys.size()), 1, 1, some, 1, 1};
        Buffer told(context(), {.name = "told", .bytes = sizeof(groups)});
        const RadixSort::Counts counts{told, 0, 3 * sizeof(uint)};
        Commands commands(context(), "sort test");
        {
            const auto pass = commands.pass("input");
            commands.upload(told, std::span<const uint>(groups));
            if (kind != Values::places) commands.upload(buffers[0], std::span(keys));
            commands.upload(buffers[4], std::span(keys));
            commands.upload(buffers[1], std::span<const uint>(values));
        }
        const RadixSort::Pairs pairs{{buffers[0].address()}, {buffers[1].address()}};
        const RadixSort::Pairs spare{{buffers[2].address()}, {buffers[3].address()}};
        const auto count = static_cast<uint>(keys.size());
        const RadixSort::Counts* const if_counts = from == Groups::from_host ? nullptr : &counts;
        const Uints by = kind == Values::places ? Uints{buffers[4].address()} : pairs.keys;
        const RadixSort::Pairs result =
            kind == Values::given
                ? sort.record(commands, pairs, spare, {counters.address()}, count, bits, if_counts)
                : sort.record_iota(commands, by, pairs, spare, {counters.address()}, count, bits, if_counts);
        commands.submit();
        EXPECT_EQ(download<uint>(context(), buffers[4], keys.size()), keys);
        const bool in_place = result.values.address == buffers[1].address();
        return download<uint>(context(), buffers[in_place ? 1 : 3], keys.size());
    }
};

std::vector<uint> expected_values(const std::vector<uint>& keys, uint bits) {
    const uint mask = bits == 32 ? ~0u : (1u << bits) - 1;
    std::vector<uint> values(keys.size());
    std::iota(values.begin(), values.end(), 0u);
    std::stable_sort(values.begin(), values.end(), [&](uint a, uint b) { return (keys[a] & mask) < (keys[b] & mask); });
    return values;
}

class RadixSortOn : public RadixSortTest, public testing::WithParamInterface<uint> {};

TEST_P(RadixSortOn, EqualsStableSortForManyCountsAndWidths) {
    const RadixSort sort(context(), GetParam());
    std::mt19937 random(1);
    for (const std::size_t count : {1u, 2u, 63u, 64u, 500u, 2047u, 2048u, 2049u, 10'000u, 200'000u}) {
        for (const uint bits : {1u, 6u, 9u, 30u}) {
            std::vector<uint> keys(count);
            for (uint& key : keys) key = static_cast<uint>(random()) & ((1u << bits) - 1);
            EXPECT_EQ(sorted_values(sort, GetParam(), keys, bits), expected_values(keys, bits))
                << count << " keys of " << bits << " bits";
        }
    }
}

TEST_P(RadixSortOn, SortsPlacesByKeysThatStay) {
    const RadixSort sort(context(), GetParam());
    std::mt19937 random(3);
    for (const std::size_t count : {1u, 2u, 500u, 200'000u})
        for (const uint bits : {1u, 12u, 30u}) {
            std::vector<uint> keys(count);
            for (uint& key : keys) key = static_cast<uint>(random()) & ((1u << bits) - 1);
            for (const Groups from : {Groups::from_host, Groups::from_device})
                for (const Values kind : {Values::places, Values::places_by_own_keys})
                    EXPECT_EQ(sorted_values(sort, GetParam(), keys, bits, from, kind), expected_values(keys, bits))
                        << count << " keys of " << bits << " bits";
        }
}

TEST_P(RadixSortOn, EqualKeysKeepTheirOrder) {
    const RadixSort sort(context(), GetParam());
    const std::vector<uint> keys(5000, 42u);
    EXPECT_EQ(sorted_values(sort, GetParam(), keys, 30), expected_values(keys, 30));
}

TEST_P(RadixSortOn, DevicesMaySayThatItIsWantedOrNot) {
    const RadixSort sort(context(), GetParam());
    std::mt19937 random(2);
    for (const std::size_t count : {3000u, 200'000u}) {
        std::vector<uint> keys(count), untouched(count);
        for (uint& key : keys) key = static_cast<uint>(random()) >> 2;
        std::iota(untouched.begin(), untouched.end(), 0u);
        EXPECT_EQ(sorted_values(sort, GetParam(), keys, 30, Groups::from_device), expected_values(keys, 30));
        // An odd number of passes would end in the spare.
        const uint even = 2 * RadixSort::digit_bits(GetParam());
        EXPECT_EQ(sorted_values(sort, GetParam(), keys, even, Groups::none_from_device), untouched);
    }
}

INSTANTIATE_TEST_SUITE_P(Threads, RadixSortOn, testing::Values(0u, 1u, 2u, 5u),
                         [](const auto& param) { return param.param ? text("cpu", param.param) : "gpu"; });

TEST(RadixSortRun, IsLongWhereAProcessorRunsTheThreads) {
    EXPECT_EQ(RadixSort::run_of(100'000'000, 0), 32u);
    EXPECT_EQ(RadixSort::run_of(40'000, 2), 2500u);
    EXPECT_EQ(RadixSort::run_of(100'000'000, 2), SORT_LONGEST_RUN);
}

TEST(RadixSortRun, CountersHaveRoomForAllGroups) {
    for (const uint threads : {0u, 1u, 2u, 3u, 16u, 256u})
        for (std::uint64_t count = 1; count < 5'000'000'000; count += 1 + count / 7) {
            const std::uint64_t counters = std::uint64_t{RadixSort::groups_of(count, threads)}
                                           << RadixSort::digit_bits(threads);
            EXPECT_LE(counters * sizeof(uint) + RadixSort::kept_bytes(count, threads),
                      RadixSort::counter_bytes(count, threads))
                << count << " on " << threads;
        }
}

TEST(RadixSortRun, ManySortsNeedNoFewerCountersThanOneOfAll) {
    for (const uint threads : {0u, 1u, 2u, 5u})
        for (std::uint64_t a = 1; a < 1'000'000; a += 1 + a / 3)
            for (std::uint64_t b = 1; b < 1'000'000; b += 1 + b / 3)
                EXPECT_LE(RadixSort::counter_bytes(a + b, threads),
                          RadixSort::counter_bytes(a, threads) + RadixSort::counter_bytes(b, threads))
                    << a << " and " << b << " on " << threads;
}

TEST(RadixSortRun, KeepsColumnsWhereItemsAreMany) {
    EXPECT_EQ(RadixSort::kept_bytes(100'000'000, 0), 0u);
    EXPECT_EQ(RadixSort::kept_bytes(40'000, 2), 0u);
    EXPECT_EQ(RadixSort::kept_bytes(150'000, 2), 4u * 8 * 1024 * sizeof(uint));
}

}  // namespace
}  // namespace twinray
