// Texels of every format and number of channels, and their mipmaps, as kernels read them.
#include "engine/scene/images.h"
#include "tests/scene/temp_dir.h"
#include "tests/scene/texture_fixture.h"

namespace twinray::test {
namespace {

class TextureFormats : public Textures {};
INSTANTIATE_TEST_SUITE_P(As, TextureFormats, ::testing::Values(TextureStorage::images, TextureStorage::buffers),
                         name_of_storage);

constexpr std::array all_formats = {TexelFormat::unorm8, TexelFormat::unorm16, TexelFormat::float16,
                                    TexelFormat::float32};

// Random numbers, and the colours that kernels should read of them, four numbers a texel.
struct Sample {
    Texels texels;
    std::vector<vec4> colors;

    float largest() const {
        float magnitude = 1;
        for (const vec4& color : colors)
            for (int channel = 0; channel < 4; ++channel) magnitude = std::max(magnitude, std::abs(color[channel]));
        return magnitude;
    }
};
Sample random_sample(TexelFormat format, uint channels, uint width, uint height, uint seed) {
    std::mt19937 random(seed);
    std::vector<std::byte> bytes;
    Sample sample;
    const auto add = [&](const auto& number) {
        const auto raw = std::as_bytes(std::span(&number, 1));
        bytes.insert(bytes.end(), raw.begin(), raw.end());
    };
    for (uint texel = 0; texel < width * height; ++texel) {
        vec4 color(0, 0, 0, 1);
        for (uint channel = 0; channel < channels; ++channel) {
            if (format == TexelFormat::unorm8) {
                const auto number = static_cast<std::uint8_t>(random());
                add(number);
                color[channel] = static_cast<float>(number) / 255.0f;
            } else if (format == TexelFormat::unorm16) {
                const auto number = static_cast<std::uint16_t>(random());
                add(number);
                color[channel] = static_cast<float>(number) / 65535.0f;
            } else if (format == TexelFormat::float16) {  // 1024 to 2047 times a power of two, of either sign
                const auto number = static_cast<std::uint16_t>(random() % 0x7800 | (random() & 1u) << 15);
                add(number);
                const int exponent = number >> 10 & 31;
                const double value =
                    std::ldexp((exponent ? 1024.0 : 0.0) + (number & 1023), std::max(exponent, 1) - 25);
                color[channel] = static_cast<float>(number & 0x8000 ? -value : value);
            } else {
                const float number =
                    std::ldexp(static_cast<float>(random()) / 1e9f - 2, static_cast<int>(random() % 60) - 30);
                add(number);
                color[channel] = number;
            }
        }
        sample.colors.push_back(color);
    }
    sample.texels = {
        text("format ", int(format), " of ", channels), width, height, channels, format, {std::move(bytes)}};
    return sample;
}

// docs/multi-type-set.md describes these values; a device's samplers may make infinity or NaN of them between texels.
TEST_P(TextureFormats, ExtremeNumbersStay) {
    for (const float number : {INFINITY, -INFINITY, 3e38f, -0.0f})
        for (const Filter filter : {Filter::nearest, Filter::linear}) {
            const std::vector<float> numbers(20 * 20, number);
            const TextureRef texture =
                store().push(Texels::of("extreme", 20, 20, 1, TexelFormat::float32, std::span<const float>(numbers)),
                             {.filter = filter});
            store().sync();
            const TextureAnswer answer = answers_to({{texture, 7, 7, vec2(0.37f), 0}}).front();
            EXPECT_EQ(answer.texel.x, number);
            if (filter == Filter::nearest || std::isfinite(number) || GetParam() == TextureStorage::buffers)
                EXPECT_TRUE(answer.color.x == number || std::abs(answer.color.x / number - 1) < 1e-6f) << number;
            else
                EXPECT_FALSE(std::isfinite(answer.color.x)) << number;
        }
}

TEST_P(TextureFormats, EachTexelIsItsNumbers) {
    for (const TexelFormat format : all_formats)
        for (uint channels = 1; channels <= 4; ++channels) {
            const Sample sample = random_sample(format, channels, 5, 3, 10 * uint(format) + channels);
            const TextureRef texture = store().push(sample.texels);
            store().sync();
            std::vector<TextureQuestion> questions;
            for (int y = 0; y < 3; ++y)
                for (int x = 0; x < 5; ++x) questions.push_back({texture, x, y, (vec2(x, y) + 0.5f) / vec2(5, 3), 0});
            const std::vector<TextureAnswer> answers = answers_to(questions);
            for (std::size_t i = 0; i < answers.size(); ++i) {
                EXPECT_EQ(answers[i].levels, 1u);
                for (uint channel = 0; channel < 4; ++channel) {
                    const float expected = sample.colors[i][channel], near = 1e-6f * std::abs(expected);
                    EXPECT_NEAR(answers[i].texel[channel], expected, near) << sample.texels.name;
                    // At a texel's middle, its neighbours contribute only by a rounding of the place, or by the
                    // samplers' few bits.
                    if (store().has_images()) continue;
                    EXPECT_NEAR(answers[i].color[channel], expected, 1e-6f * sample.largest()) << sample.texels.name;
                }
            }
        }
}

TEST_P(TextureFormats, FloatsBeyondOneAreFilteredAsTheyAre) {
    const float ramp[] = {-1000, 1000, 3000, 5000};
    const TextureRef texture =
        store().push(Texels::of("ramp", 4, 1, 1, TexelFormat::float32, std::span<const float>(ramp)),
                     {.wrap_u = Wrap::clamp_to_edge});
    store().sync();
    std::vector<TextureQuestion> questions;
    for (int i = 0; i <= 100; ++i)
        questions.push_back({texture, 0, 0, vec2(0.125f + 0.0075f * static_cast<float>(i), 0.5f), 0});
    const std::vector<TextureAnswer> answers = answers_to(questions);
    for (std::size_t i = 0; i < answers.size(); ++i)
        EXPECT_NEAR(answers[i].color.x, -1000 + 60 * static_cast<float>(i), 2000.0f / 256 + 0.01f) << i;
}

TEST_P(TextureFormats, MipmapsBlurAndAreBlended) {
    std::vector<float> numbers(2 * 13 * 6);
    double mean = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i % 7);
    for (std::size_t i = 0; i < numbers.size(); i += 2) mean += numbers[i] / (13.0 * 6.0);
    const Texels texels =
        with_mipmaps(Texels::of("grid", 13, 6, 2, TexelFormat::float32, std::span<const float>(numbers)));
    ASSERT_EQ(texels.levels.size(), 4u);  // 13 x 6, 6 x 3, 3 x 1, 1 x 1
    const TextureRef texture = store().push(texels);
    const TextureRef nearest = store().push(texels, {.between_levels = Filter::nearest});
    store().sync();
    const auto at = [&](TextureRef which, float lod) {
        const TextureQuestion question{which, 0, 0, vec2(0.5f), lod};
        return answers_to({question}).front();
    };
    EXPECT_EQ(at(texture, 0).levels, 4u);
    EXPECT_NEAR(at(texture, 3).lod_color.x, mean, 1e-5);
    EXPECT_NEAR(at(texture, 90).lod_color.x, mean, 1e-5);
    const float two = at(texture, 2).lod_color.x, three = at(texture, 3).lod_color.x;
    EXPECT_NE(two, three);
    EXPECT_NEAR(at(texture, 2.5f).lod_color.x, (two + three) / 2, 0.01f);
    EXPECT_NEAR(at(nearest, 2.4f).lod_color.x, two, 1e-5f);
    EXPECT_NEAR(at(nearest, 2.6f).lod_color.x, three, 1e-5f);
    EXPECT_EQ(at(texture, -1).lod_color.x, at(texture, -1).color.x);
}

TEST_P(TextureFormats, SixteenBitsOfSrgbAreLinearLight) {
    const std::uint16_t gray[] = {0, 1000, 32768, 65535};
    const TextureRef texture = store().push(
        Texels::of("gray", 4, 1, 1, TexelFormat::unorm16, std::span<const std::uint16_t>(gray)), {.is_srgb = true});
    const TextureRef narrow =
        store().push(Texels::of("gray8", 1, 1, 2, TexelFormat::unorm8, std::span<const std::uint8_t>({128, 128})),
                     {.is_srgb = true});
    store().sync();
    for (int x = 0; x < 4; ++x) {
        const double c = gray[x] / 65535.0, linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(answers_to({{texture, x, 0, vec2(0.5f), 0}}).front().texel.x, linear, 0.51 / 65535) << x;
    }
    EXPECT_NEAR(answers_to({{narrow, 0, 0, vec2(0.5f), 0}}).front().texel.y, 0.2158605, 1e-3);
}

TEST_P(TextureFormats, AnUpdateMayChangeTheFormat) {
    const TextureRef texture = store().push(random_sample(TexelFormat::unorm8, 4, 2, 2, 1).texels, {.is_srgb = true});
    store().sync();
    const std::uint64_t revision = store().revision();
    const std::uint16_t white[] = {65535, 65535, 65535, 65535};
    store().update(texture, Texels::of("white", 1, 1, 4, TexelFormat::unorm16, std::span<const std::uint16_t>(white)));
    store().sync();
    EXPECT_GT(store().revision(), revision);
    EXPECT_EQ(answers_to({{texture, 0, 0, vec2(0.5f), 0}}).front().texel, vec4(1));
}

TEST_P(TextureFormats, WhatCannotBeIsRefused) {
    const Sample sample = random_sample(TexelFormat::float32, 2, 4, 4, 1);
    const auto refused = [&](const char* why, const TextureOptions& options,
                             const std::function<void(Texels&)>& change) {
        Texels texels = sample.texels;
        change(texels);
        expect_error(why, [&] { store().push(texels, options); });
    };
    refused("has 5 channels; 1 to 4 fit", {}, [](Texels& t) { t.channels = 5; });
    refused("has 128 bytes in level 0; it needs 120", {}, [](Texels& t) { t.width = 5, t.height = 3; });
    refused("has no texels", {}, [](Texels& t) { t.levels.clear(); });
    refused("has 4 levels; at most 3", {}, [](Texels& t) { t.levels.resize(4); });
    refused("is sRGB in floats", {.is_srgb = true}, [](Texels&) {});
    EXPECT_EQ(store().size(), 0u);
}

TEST(Mipmaps, AreMeansOfLinearLight) {
    const std::uint8_t two[] = {0, 0, 0, 0, 255, 255, 255, 255};
    const Texels texels = Texels::of("two", 2, 1, 4, TexelFormat::unorm8, std::span<const std::uint8_t>(two));
    EXPECT_EQ(with_mipmaps(texels).levels[1][0], std::byte(128));
    const std::vector<std::byte> coded = with_mipmaps(texels, true).levels[1];
    EXPECT_EQ(coded[0], std::byte(188));  // half of the light in sRGB
    EXPECT_EQ(coded[3], std::byte(128));
}

}  // namespace
}  // namespace twinray::test
