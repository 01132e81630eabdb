// Films, and the order of the samples that fill them: their devices, and the effect of adaptive sampling on pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <random>

#include "engine/core/error.h"
#include "renderer/film_file.h"
#include "renderer/renderer.h"
#include "renderer/rounds.h"
#include "samples/support/ranks.h"
#include "tests/scene/temp_dir.h"

namespace twinray::path_tracer {
namespace {

// Returns samples of radiance of very unlike sizes, with zeros and negative numbers.
std::vector<vec3> some_samples(std::size_t count, uint seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> mantissa(-0.1f, 1), exponent(-140, 120);
    std::vector<vec3> samples;
    for (std::size_t i = 0; i < count; ++i) {
        const auto number = [&] { return mantissa(random) * std::exp2(exponent(random)); };
        samples.push_back(i % 7 == 0 ? vec3(0) : vec3(number(), number(), number()));
    }
    return samples;
}

Film film_of(std::span<const vec3> samples, uint first_block = 0, const Configuration& configuration = {}) {
    Film film = Film::empty(1, 1, 1, configuration);
    for (const vec3& sample : samples) {
        film.add(0, sample);
        film.blocks.insert(first_block++);
    }
    return film;
}

bool same_bytes(const Film& a, const Film& b) {
    return a.blocks == b.blocks && a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(FilmPixel)) == 0;
}

class FilmFile : public ::testing::Test {
  protected:
    const test::TempDir temp_;
    const std::filesystem::path file_ = temp_ / "test.film";
};

TEST(Film, SumsDependNeitherOnOrderNorOnGrouping) {
    std::vector<vec3> samples = some_samples(300, 1);
    const Film whole = film_of(samples);
    for (uint seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        std::shuffle(samples.begin(), samples.end(), random);
        const std::size_t cut = random() % 299 + 1;
        Film first = film_of(std::span(samples).first(cut));
        const Film second = film_of(std::span(samples).subspan(cut), static_cast<uint>(cut));
        Film other_way = second;
        other_way.merge(first, "second", "first");
        first.merge(second, "first", "second");
        EXPECT_TRUE(same_bytes(first, whole)) << "cut after " << cut;
        EXPECT_TRUE(same_bytes(other_way, whole)) << "cut after " << cut;
    }
}

TEST(Film, SumsAreExactForNumbersOfLikeSize) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(1e-4f, 100);
    Film film = Film::empty(1, 1, 1, {});
    double sum = 0, squares = 0;
    for (int i = 0; i < 1000; ++i) {
        const float x = number(random);
        film.add(0, vec3(x, 2 * x, -x));
        const double l = static_cast<double>(luminance(vec3(x, 2 * x, -x)));
        sum += static_cast<double>(x), squares += l * l;
    }
    EXPECT_EQ(sum_of(film.pixels[0], 0), sum);
    EXPECT_EQ(sum_of(film.pixels[0], 1), 2 * sum);
    EXPECT_EQ(sum_of(film.pixels[0], 2), -sum);
    EXPECT_NEAR(sum_of(film.pixels[0], FILM_SQUARES), squares, 1e-12 * squares);
}

TEST(Film, HoldsWhateverFloatsHold) {
    for (const float x : {std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::min(), 1e-30f, 1.0f,
                          -1.0f, 1e30f, std::numeric_limits<float>::max()}) {
        Film film = Film::empty(1, 1, 1, {});
        film.add(0, vec3(0, x, 0));
        EXPECT_EQ(film.mean().rgb[0], vec3(0, x, 0));
        const double l = static_cast<double>(luminance(vec3(0, x, 0)));
        EXPECT_EQ(sum_of(film.pixels[0], FILM_SQUARES), l * l);
    }
}

// One photon of 1 falls among a million of 2^-41 of it.
TEST(Film, LeavesOutLessThanTheLargestNumberTimesTheirCountTimesTwoToTheMinus40) {
    Film film = Film::empty(1, 1, 1, {});
    film.add(0, vec3(0x1p31f));  // one bit above a place: the worst case
    for (int i = 0; i < 1000; ++i) film.add(0, vec3(1.9f));
    EXPECT_NEAR(sum_of(film.pixels[0], 0), 0x1p31 + 1900, 1001 * 0x1p31 * 0x1p-40);
}

TEST(Film, KnowsTheErrorOfItsPixels) {
    // Two pixels of 4 blocks of 2 samples; the blocks' sums have means 6 and 2, and variances 20 / 3 and 0.
    Film film = Film::empty(2, 1, 2, {});
    for (const float sum : {3.0f, 9.0f, 5.0f, 7.0f}) film.add(0, vec3(sum));
    for (int i = 0; i < 4; ++i) film.add(1, vec3(2));
    EXPECT_EQ(film.mean().rgb[0], vec3(3));
    EXPECT_EQ(film.mean_samples(), 8);
    EXPECT_NEAR(film.variances()[0], 20.0 / 3 / 4 / 4, 1e-6);
    EXPECT_NEAR(film.variances()[1], 0, 1e-6);
    EXPECT_NEAR(film.error(), std::sqrt(20.0 / 3 / 4 / 4 / 2) / 2, 1e-6);
    Film one = Film::empty(1, 1, 1, {});
    one.add(0, vec3(1));
    EXPECT_EQ(one.error(), std::numeric_limits<double>::infinity()) << "one block tells nothing";
}

TEST(Film, BlockSetsAreSetsOfNumbers) {
    BlockSet odd, large;
    for (uint i = 1; i < 100; i += 2) odd.insert(i);
    large.insert(100);
    large.insert(2000);
    EXPECT_EQ(odd.count(), 50u);
    EXPECT_EQ(odd.end(), 100u);
    EXPECT_EQ(large.end(), 2001u);
    EXPECT_TRUE(odd.contains(99) && !odd.contains(98) && !odd.contains(5000));
    EXPECT_FALSE(odd.common(large).has_value());
    large.insert(99);
    EXPECT_EQ(odd.common(large), 99u);
    odd.unite(large);
    EXPECT_EQ(odd.count(), 52u);
    EXPECT_EQ(BlockSet().end(), 0u);
}

TEST(Film, RefusesWhatIsNotOfItsPicture) {
    const Configuration here = {{"seed", "1"}, {"scene", "a"}}, there = {{"seed", "2"}, {"scene", "a"}};
    const std::vector<vec3> samples = some_samples(3, 1);
    Film film = film_of(samples, 0, here);
    EXPECT_EQ(test::error_of([&] { film.merge(film_of(samples, 3, there), "a.film", "b.film"); }),
              "'b.film' is not a film of the same picture as 'a.film': seed is 2, not 1");
    EXPECT_EQ(test::error_of([&] { film.merge(film_of(samples, 2, here), "a.film", "b.film"); }),
              "'b.film' and 'a.film' both hold samples 2 to 2 of each pixel; a sample may count only once");
    EXPECT_EQ(difference({{"a", "1"}}, {{"b", "2"}}), "b is missing, not 2; a is 1, not there");
}

TEST_F(FilmFile, GivesBackWhatWasSaved) {
    const Configuration configuration = {{"seed", "1"}, {"scene", "with: colons"}};
    const Film film = film_of(some_samples(50, 3), 7, configuration);
    save_film(file_, film);
    const Film loaded = load_film(file_);
    EXPECT_TRUE(same_bytes(film, loaded));
    EXPECT_EQ(loaded.configuration, configuration);
    EXPECT_EQ(loaded.block_size, 1u);
}

TEST_F(FilmFile, SeesDamageAndForeignFiles) {
    const Configuration configuration = {{"seed", "1"}};
    save_film(file_, film_of(some_samples(5, 3), 0, configuration));
    std::ifstream in(file_, std::ios::binary);
    const std::string whole(std::istreambuf_iterator<char>(in), {});
    const std::pair<std::size_t, const char*> rows[] = {{0, "not a film"},
                                                        {13, "another version"},
                                                        {16, "cut short or damaged"},
                                                        {45, "checksum"},
                                                        {whole.size() - 30, "checksum"}};
    for (const auto& [at, words] : rows) {
        std::string broken = whole;
        broken[at] = static_cast<char>(broken[at] ^ 1);
        test::expect_error(words, [&] { load_film(temp_.write("broken.film", broken)); });
    }
    EXPECT_NO_THROW(load_film(file_));
    test::expect_error("cut short", [&] { load_film(temp_.write("short.film", whole.substr(0, whole.size() - 1))); });
}

constexpr uint side = 16;

// Returns one of a pixel's independent samples.
using Source = std::function<float(uint pixel, std::mt19937& random)>;

void add_round(Film& film, const Round& round, const Source& source, std::mt19937& random) {
    const std::vector<uint> all = pixel_order(film.width, film.height);
    for (uint block = round.first; block < round.first + round.count; ++block) {
        for (const uint pixel : round.pixels.empty() ? all : round.pixels) {
            float sum = 0;
            for (uint i = 0; i < film.block_size; ++i) sum += source(pixel, random);
            film.add(pixel, vec3(sum));
        }
        film.blocks.insert(block);
    }
}

Film adaptive_film(const StoppingRules& rules, const Source& source, uint seed) {
    Film film = Film::empty(side, side, adaptive_block_size, {});
    std::mt19937 random(seed);
    while (const auto round = next_round(film, rules, {})) add_round(film, *round, source, random);
    return film;
}

// Returns 1 on average; the lower half of the film has bright paths, one in twenty.
float uneven(uint pixel, std::mt19937& random) {
    std::uniform_real_distribution<float> number;
    if (pixel < side * side / 2) return 0.9f + 0.2f * number(random);
    return number(random) < 0.05f ? 20.0f : 0.0f;
}

std::vector<uint> blocks_of(const StoppingRules& rules, const Shard& shard) {
    Film film = Film::empty(1, 1, 1, {});
    std::vector<uint> blocks;
    while (const auto round = next_round(film, rules, shard)) {
        blocks.push_back(round->first);
        film.blocks.insert(round->first);
    }
    return blocks;
}

TEST(Rounds, ShardsTakeTurns) {
    EXPECT_EQ(blocks_of({.samples = 3}, {}), (std::vector<uint>{0, 1, 2}));
    EXPECT_EQ(blocks_of({.samples = 7}, {0, 3}), (std::vector<uint>{0, 3, 6}));
    EXPECT_EQ(blocks_of({.samples = 7}, {2, 3}), (std::vector<uint>{2, 5}));
    EXPECT_EQ(blocks_of({.samples = 2}, {2, 3}), std::vector<uint>{}) << "more shards than samples";
}

TEST(Rounds, WhatAFilmLacksIsRendered) {
    Film film = Film::empty(1, 1, 1, {});
    film.blocks = BlockSet({0b101});
    EXPECT_EQ(next_round(film, {.samples = 4}, {})->first, 1u);
    film.blocks.insert(1);
    EXPECT_EQ(next_round(film, {.samples = 4}, {})->first, 3u);
    film.blocks.insert(3);
    EXPECT_FALSE(next_round(film, {.samples = 4}, {}).has_value());
}

TEST(Rounds, PixelsGetAsManySamplesAsTheyNeed) {
    const Film film = adaptive_film({.samples = 1 << 16, .error = 0.1}, uneven, 1);
    EXPECT_LE(film.error(), 0.1);
    EXPECT_GT(film.error(), 0.09);
    // Half of the pixels have a variance of 19 per sample, the others next to none: the same number for each would take
    // 950 samples.
    EXPECT_LT(film.mean_samples(), 750);
    EXPECT_GT(film.pixels.back().count, 5 * film.pixels.front().count);
    EXPECT_GT(film.pixels.front().count, 2 * pilot_blocks) << "none is left alone";
}

// A corner has few neighbours that see it, so none lacks blocks before the error is what it should be.
TEST(Rounds, ANoisyCornerIsNoDeadEnd) {
    const Source corner = [](uint pixel, std::mt19937& random) {
        return pixel == 0 ? uneven(side * side - 1, random) : 1.0f;
    };
    Film film = Film::empty(side, side, adaptive_block_size, {});
    std::mt19937 random(1);
    bool had_none_lacking = false;
    while (const auto round = next_round(film, {.samples = 1 << 16, .error = 0.01}, {})) {
        EXPECT_EQ(round->pixels.empty(), film.blocks.count() == 0) << "what follows the pilot is named";
        had_none_lacking |= film.blocks.count() > 0 && round->pixels.size() == film.pixels.size();
        add_round(film, *round, corner, random);
    }
    EXPECT_TRUE(had_none_lacking);
    EXPECT_LE(film.error(), 0.01);
}

TEST(Rounds, TheLimitOfSamplesHolds) {
    const Film film = adaptive_film({.samples = 100, .error = 1e-3}, uneven, 1);
    EXPECT_EQ(film.blocks.end(), 100 / adaptive_block_size);
    for (const FilmPixel& pixel : film.pixels) EXPECT_LE(pixel.count, 100 / adaptive_block_size);
}

// Deciding by the samples that are kept favours pixels that missed the bright paths.
TEST(Rounds, AdaptivePicturesAreNeitherTooDarkNorTooBright) {
    constexpr uint seeds = 200;
    double sum = 0, squares = 0;
    for (uint seed = 0; seed < seeds; ++seed) {
        const double mean = mean_luminance(adaptive_film({.samples = 1 << 16, .error = 0.25}, uneven, seed));
        sum += mean, squares += mean * mean;
    }
    const double mean = sum / seeds, error = std::sqrt((squares / seeds - mean * mean) / seeds);
    EXPECT_NEAR(mean, 1, 4 * error);
    EXPECT_LT(error, 2e-3) << "else nothing is shown";
}

TEST(Rounds, TheErrorIsWhatItSays) {
    double squares = 0;
    constexpr uint seeds = 50;
    for (uint seed = 0; seed < seeds; ++seed)
        for (const vec3& pixel : adaptive_film({.samples = 1 << 16, .error = 0.2}, uneven, seed).mean().rgb)
            squares += std::pow(static_cast<double>(pixel.y) - 1, 2);
    EXPECT_NEAR(std::sqrt(squares / seeds / side / side), 0.2, 0.02);
}

TEST(Rounds, TheFractionDoneIsThatOfTheRuleThatComesFirst) {
    const BlockSet four({0b1111});
    EXPECT_EQ(fraction_done(four, 1, {.samples = 16}, {}, 0, INFINITY), 0.25);
    EXPECT_EQ(fraction_done(four, 1, {.samples = 16}, {0, 2}, 0, INFINITY), 0.5);
    EXPECT_EQ(fraction_done(four, 8, {.samples = 128}, {}, 0, INFINITY), 0.25);
    EXPECT_EQ(fraction_done(four, 1, {.samples = 16, .seconds = 10}, {}, 5, INFINITY), 0.5);
    EXPECT_EQ(fraction_done(four, 1, {.samples = 100, .error = 0.1}, {}, 0, 0.2), 0.25);
}

TEST(PixelOrder, GoesThroughEachPixelOnceInSquaresOfEight) {
    std::vector<uint> order = pixel_order(20, 18);
    for (uint i = 0; i < 64; ++i) EXPECT_TRUE(order[i] % 20 < 8 && order[i] / 20 < 8);
    std::sort(order.begin(), order.end());
    for (uint i = 0; i < 360; ++i) ASSERT_EQ(order[i], i);
}

DeviceProperties device(DeviceKind kind) {
    DeviceProperties properties;
    properties.kind = kind;
    properties.api_version = VK_API_VERSION_1_3;
    properties.has_compute_queue = properties.timeline_semaphore = properties.buffer_device_address = true;
    properties.scalar_block_layout = properties.shader_int64 = true;
    properties.group_invocations = 1024;
    return properties;
}

TEST(Ranks, TakeTurnsOnTheBestDevices) {
    const std::vector<DeviceProperties> machine = {device(DeviceKind::cpu), device(DeviceKind::discrete),
                                                   device(DeviceKind::integrated), device(DeviceKind::discrete)};
    EXPECT_EQ(samples::device_of_rank(machine, 0), 1u);
    EXPECT_EQ(samples::device_of_rank(machine, 1), 3u);
    EXPECT_EQ(samples::device_of_rank(machine, 2), 1u);
    EXPECT_EQ(samples::device_of_rank(std::span(machine).first(1), 5), 0u);
    EXPECT_EQ(samples::device_of_rank({}, 1), 0u);
}

}  // namespace
}  // namespace twinray::path_tracer
