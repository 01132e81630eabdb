// SPDX-License-Identifier: MIT
// The order of samples, their devices, and the effect of adaptive sampling on the picture.
#include "renderer/rounds.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "samples/support/ranks.h"
#include "renderer/renderer.h"

namespace twinray::path_tracer {
namespace {

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
