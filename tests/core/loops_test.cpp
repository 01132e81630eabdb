// Loops over tuples at compile time, and over indices on threads.
#include <twinray/sets.h>

#include <chrono>
#include <thread>

#include "engine/core/parallel.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

struct Lamp {
    int watts;
};
struct Sun {
    double power;
};

struct PowerOf {
    constexpr double operator()(const Lamp& lamp, double scale) const { return lamp.watts * scale; }
    constexpr double operator()(const Sun& sun, double scale) const { return sun.power * scale; }
};

constexpr std::tuple lights{Lamp{60}, Sun{1000}, Lamp{40}};

// Runs each of them in a constant expression: no heap and no run time.
static_assert([] {
    double total = 0;
    for_unrolled([](const auto& light, double& sum) { sum = 10 * sum + PowerOf{}(light, 0.001); }, lights, total);
    return total;
}() == (0.06 * 10 + 1) * 10 + 0.04);
static_assert([] {
    std::array<int, 4> squares{};
    for_unrolled<4>([](auto i, auto& to) { std::get<i>(to) = static_cast<int>(i * i); }, squares);
    return squares;
}() == std::array{0, 1, 4, 9});
static_assert(map_unrolled(PowerOf{}, lights, 2.0) == std::tuple{120.0, 2000.0, 80.0});
static_assert(map_unrolled(PowerOf{}, std::tuple{}, 2.0) == std::tuple{});
static_assert(reduce_unrolled([](int sum, const auto& x, int base) { return sum * base + static_cast<int>(x); },
                              std::tuple{1, 2u, 3.0}, 0, 10) == 123);
static_assert(reduce_unrolled([](int, int) { return 0; }, std::tuple{}, 7) == 7);
static_assert(sum_unrolled(PowerOf{}, lights, 1.0) == 1100.0);
static_assert(get_unrolled(PowerOf{}, lights, 1, 0.5) == 500.0);
static_assert(get_unrolled(PowerOf{}, lights, 2, 1.0) == 40.0);

static_assert(map_unrolled([](int x) { return std::tuple{x}; }, std::tuple{5}) ==
              std::tuple<std::tuple<int>>{std::tuple{5}});

template <class F>
constexpr bool is_accepted_by_all = requires(F f, std::tuple<int, int> t) {
    for_unrolled(f, t);
    for_unrolled<2>(f);
    map_unrolled(f, t);
    sum_unrolled(f, t);
    get_unrolled(f, t, 0);
    reduce_unrolled(f, t, 0);
};
template <class F>
constexpr bool is_accepted_by_any = requires(F f, std::tuple<int, int> t) {
    for_unrolled(f, t);
}
|| requires(F f) { for_unrolled<2>(f); }
|| requires(F f, std::tuple<int, int> t) { map_unrolled(f, t); }
|| requires(F f, std::tuple<int, int> t) { sum_unrolled(f, t); }
|| requires(F f, std::tuple<int, int> t) { get_unrolled(f, t, 0); }
|| requires(F f, std::tuple<int, int> t) { reduce_unrolled(f, t, 0); };

TEST(Unrolled, FunctorsThatCaptureAreRefused) {
    int captured = 1;
    const auto captures = [captured](int x, int y = 0) { return x + y + captured; };
    const auto captures_nothing = [](int x, int y = 0) { return x + y; };
    EXPECT_FALSE(is_accepted_by_any<decltype(captures)>);
    EXPECT_FALSE(is_accepted_by_any<int (*)(int)>) << "a function pointer is called through, not unrolled";
    EXPECT_TRUE(is_accepted_by_all<decltype(captures_nothing)>);
}

TEST(Unrolled, ElementsCanBeChangedInPlace) {
    std::tuple numbers{1, 2.5, 3L};
    for_unrolled([](auto& x, int factor) { x = static_cast<std::remove_reference_t<decltype(x)>>(x * factor); },
                 numbers, 2);
    EXPECT_EQ(numbers, (std::tuple{2, 5.0, 6L}));
}

TEST(Unrolled, AnElementFoundAtRunTimeCanBeWritten) {
    std::tuple pair{std::array{1, 2}, std::array{3, 4}};
    for (std::size_t i = 0; i < 2; ++i) get_unrolled([](auto& x) -> int& { return x[1]; }, pair, i) += 10;
    EXPECT_EQ(std::get<0>(pair)[1], 12);
    EXPECT_EQ(std::get<1>(pair)[1], 14);
    int calls = 0;
    get_unrolled([](const auto&, int& count) { ++count; }, pair, 1, calls);
    EXPECT_EQ(calls, 1);
}

TEST(Unrolled, AnIndexOutOfRangeIsRefusedAndNothingIsCalled) {
    int calls = 0;
    const auto count = [](const auto&, int& n) { ++n; };
    for (const std::size_t index : {std::size_t{3}, SIZE_MAX})
        EXPECT_EQ(test::error_of([&] { get_unrolled(count, lights, index, calls); }),
                  text("get_unrolled: index ", index, " of a tuple of 3"));
    EXPECT_EQ(calls, 0);
}

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

// Later ranges fail sooner.
TEST(ParallelFor, TheFirstRangeThatFailsIsToldHoweverLate) {
    for (int time = 0; time < 20; ++time)
        EXPECT_THROW(
            {
                try {
                    parallel_for(
                        64,
                        [](std::size_t begin, std::size_t) {
                            if (begin < 8) std::this_thread::sleep_for(std::chrono::milliseconds(8 - begin));
                            throw std::runtime_error(std::to_string(begin));
                        },
                        4);
                } catch (const std::runtime_error& error) {
                    EXPECT_STREQ(error.what(), "0");
                    throw;
                }
            },
            std::runtime_error);
}

}  // namespace
}  // namespace twinray
