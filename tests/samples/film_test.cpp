// SPDX-License-Identifier: MIT
#include "renderer/film_file.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "engine/core/error.h"
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
    const auto size = std::filesystem::file_size(file_);
    const auto broken = [&](std::streamoff at) {
        std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
        stream.seekg(at);
        const int old = stream.get();
        stream.seekp(at);
        stream.put(static_cast<char>(old ^ 1));
        stream.close();
        const std::string message = test::error_of([&] { load_film(file_); });
        std::fstream back(file_, std::ios::binary | std::ios::in | std::ios::out);
        back.seekp(at);
        back.put(static_cast<char>(old));
        return message;
    };
    test::expect_contains(broken(0), "not a film");
    test::expect_contains(broken(13), "another version");
    test::expect_contains(broken(16), "cut short or damaged");
    for (const std::streamoff at : {std::streamoff{45}, static_cast<std::streamoff>(size) - 30})
        EXPECT_NE(broken(at).find("checksum"), std::string::npos) << at;
    EXPECT_NO_THROW(load_film(file_));
    std::filesystem::resize_file(file_, size - 1);
    test::expect_error("cut short", [&] { load_film(file_); });
}

}  // namespace
}  // namespace twinray::path_tracer
