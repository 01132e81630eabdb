// Textures as images and in buffers: kernels read the same of both, and no update leaks.
#include <twinray/scene.h>

#include "tests/scene/texture_fixture.h"
#include "tests/support/caller.h"

namespace twinray {
namespace {

using test::TextureAnswer;
using test::TextureQuestion;

Image random_image(uint width, uint height, uint seed) {
    std::mt19937 random(seed);
    Image image{.name = text("image ", seed), .width = width, .height = height, .rgba = {}};
    for (uint i = 0; i < 4 * width * height; ++i) image.rgba.push_back(static_cast<std::uint8_t>(random()));
    return image;
}

Image gray_image(uint width, uint height, std::uint8_t value) {
    return {.name = "gray",
            .width = width,
            .height = height,
            .rgba = std::vector<std::uint8_t>(std::size_t{4} * width * height, value)};
}

using test::Textures;
INSTANTIATE_TEST_SUITE_P(As, Textures, ::testing::Values(TextureStorage::images, TextureStorage::buffers),
                         test::name_of_storage);

float to_linear(float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); }

vec4 texel_of(const Image& image, int x, int y, bool is_srgb) {
    const std::uint8_t* bytes = &image.rgba[4 * (static_cast<std::size_t>(y) * image.width + static_cast<uint>(x))];
    vec4 color(bytes[0], bytes[1], bytes[2], bytes[3]);
    color /= 255.0f;
    return is_srgb ? vec4(to_linear(color.x), to_linear(color.y), to_linear(color.z), color.w) : color;
}

// Returns the texel that stands for one outside.
int inside(int i, int size, Wrap wrap) {
    if (wrap == Wrap::clamp_to_edge) return std::clamp(i, 0, size - 1);
    const int period = wrap == Wrap::repeat ? size : 2 * size;
    const int in_period = ((i % period) + period) % period;
    return in_period < size ? in_period : 2 * size - 1 - in_period;
}

vec4 filtered(const Image& image, const TextureOptions& options, vec2 uv) {
    const bool is_nearest = options.filter == Filter::nearest;
    const vec2 at = uv * vec2(image.width, image.height) - (is_nearest ? 0.0f : 0.5f);
    const vec2 low = floor(at), weight = is_nearest ? vec2(0) : at - low;
    const auto texel = [&](int dx, int dy) {
        return texel_of(image, inside(static_cast<int>(low.x) + dx, static_cast<int>(image.width), options.wrap_u),
                        inside(static_cast<int>(low.y) + dy, static_cast<int>(image.height), options.wrap_v),
                        options.is_srgb);
    };
    return mix(mix(texel(0, 0), texel(1, 0), weight.x), mix(texel(0, 1), texel(1, 1), weight.x), weight.y);
}

// Returns whether the point is nearer to a texel's edge than the 8 bits in which samplers tell texels apart.
bool is_near_an_edge(const Image& image, vec2 uv) {
    const vec2 at = uv * vec2(image.width, image.height), off = abs(at - round(at));
    return std::min(off.x, off.y) < 0.01f;
}

void expect_near(vec4 value, vec4 expected, float tolerance, const std::string& what) {
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(value[i], expected[i], tolerance) << what << ", channel " << i;
}

TEST_P(Textures, KernelsFindSizesTexelsAndFilteredColours) {
    const Wrap wraps[] = {Wrap::repeat, Wrap::clamp_to_edge, Wrap::mirrored_repeat};
    std::vector<Image> images;
    std::vector<TextureOptions> options;
    std::vector<TextureQuestion> questions;
    std::mt19937 random(7);
    for (uint i = 0; i < 36; ++i) {
        images.push_back(random_image(1 + static_cast<uint>(random() % 9), 1 + static_cast<uint>(random() % 9), i));
        options.push_back({wraps[i % 3], wraps[i / 3 % 3], i / 9 % 2 == 1, i < 18 ? Filter::linear : Filter::nearest});
        const TextureRef texture = store().push(images[i], options[i]);
        EXPECT_EQ(texture.number, i + 1);
        for (int k = 0; k < 40; ++k) {
            const auto spread = [&] { return static_cast<float>(random() % 4096) / 1024 - 1.5f; };
            questions.push_back({texture, static_cast<int>(random() % 14) - 3, static_cast<int>(random() % 14) - 3,
                                 vec2(spread(), spread()), 0});
        }
    }
    store().sync();
    std::shuffle(questions.begin(), questions.end(), random);  // neighbours ask for different textures
    const std::vector<TextureAnswer> answers = answers_to(questions);
    const float decoding = store().has_images() ? 0.004f : 1e-5f;  // of sRGB: a step of 8 bits (NVIDIA)
    const float precision = store().has_images() ? 0.02f : 1e-5f;  // samplers have weights of 8 bits
    for (std::size_t i = 0; i < questions.size(); ++i) {
        const TextureQuestion& question = questions[i];
        const Image& image = images[question.texture.number - 1];
        const TextureOptions& how = options[question.texture.number - 1];
        EXPECT_EQ(answers[i].size, uvec2(image.width, image.height));
        const int x = inside(question.x, static_cast<int>(image.width), Wrap::clamp_to_edge);
        const int y = inside(question.y, static_cast<int>(image.height), Wrap::clamp_to_edge);
        expect_near(answers[i].texel, texel_of(image, x, y, how.is_srgb), decoding, image.name);
        const bool is_nearest = how.filter == Filter::nearest;
        if (is_nearest && store().has_images() && is_near_an_edge(image, question.uv)) continue;
        expect_near(answers[i].color, filtered(image, how, question.uv), is_nearest ? decoding : precision, image.name);
    }
}

TEST_P(Textures, ReferencesThatNameNothingAreWhite) {
    const TextureRef black = store().push(gray_image(2, 2, 0));
    store().sync();
    const std::vector<TextureQuestion> questions{
        {{}, 0, 0, vec2(0), 0}, {{2}, 0, 0, vec2(0), 0}, {{~0u}, 0, 0, vec2(0), 0}, {black, 0, 0, vec2(0), 0}};
    for (const bool is_debug : {false, true}) {
        const std::vector<TextureAnswer> answers = answers_to(questions, is_debug);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(answers[i].color, vec4(1));
            EXPECT_EQ(answers[i].texel, vec4(1));
            EXPECT_EQ(answers[i].size, uvec2(0));
        }
        EXPECT_EQ(answers[3].color, vec4(0));
        if (!is_debug) store().check_faults();
    }
    test::expect_error("textures: kernels met 10 references that name nothing, the first is number ",
                       [&] { store().check_faults(); });
}

TEST_P(Textures, WrongUseIsRefused) {
    const TextureRef texture = store().push(gray_image(3, 2, 9));
    EXPECT_EQ(test::error_if_any([&] { store().update({}, gray_image(3, 2, 9)); }),
              "textures: update: the texture has number 0; they go from 1 to 1");
    EXPECT_EQ(test::error_if_any([&] { store().update({2}, gray_image(3, 2, 9)); }),
              "textures: update: the texture has number 2; they go from 1 to 1");
    Image broken = gray_image(3, 2, 9);
    broken.width = 4;
    EXPECT_EQ(test::error_if_any([&] { store().push(broken); }),
              "textures: push: image 'gray' of 4 x 2 has 24 bytes in level 0; it needs 32");
    EXPECT_NE(test::error_if_any([&] { store().update(texture, gray_image(0, 0, 9)); }), "");
    EXPECT_EQ(test::error_if_any([&] { store().view(); }), "textures: view: edits are pending; call sync() first");
    EXPECT_EQ(store().size(), 1u);
    store().sync();
    EXPECT_EQ(red_of(texture), 9);
    if (!store().has_images()) return;
    test::expect_error("at most", [&] { store().push(gray_image(1, 100'000, 9)); });
}

TEST_P(Textures, TheSameSizeIsUpdatedInPlaceAndAnotherIsReplaced) {
    const TextureRef first = store().push(gray_image(8, 4, 10)), second = store().push(gray_image(4, 4, 20));
    store().sync();
    EXPECT_EQ(store().revision(), 1u);
    const TextureTable before = store().view();
    const VkDescriptorSet images = store().images();
    context().wait_for_gpu();
    const std::uint64_t bytes = live_bytes();
    store().update(first, gray_image(8, 4, 30));
    store().sync();
    context().wait_for_gpu();
    EXPECT_EQ(live_bytes(), bytes);
    const TextureTable after = store().view();
    EXPECT_EQ(std::memcmp(&before, &after, sizeof before), 0);
    EXPECT_EQ(store().images(), images);
    EXPECT_EQ(red_of(first), 30);
    store().update(first, gray_image(4, 8, 40));
    store().sync();
    EXPECT_EQ(store().revision(), 2u);
    EXPECT_EQ(red_of(first), 40);
    EXPECT_EQ(red_of(second), 20);
    EXPECT_EQ(answers_to({{first, 0, 0, vec2(0), 0}}).front().size, uvec2(4, 8));
}

TEST_P(Textures, AThousandUpdatesLeakNothing) {
    const TextureRef texture = store().push(gray_image(64, 64, 1)), other = store().push(gray_image(1, 1, 77));
    store().sync();
    context().wait_for_gpu();
    const std::uint64_t bytes = live_bytes();
    const faults::Counts objects = injector_.live_objects();
    for (uint i = 0; i < 1000; ++i) {
        const uint side = i / 10 % 2 ? 64 : 48;  // a hundred times another size
        store().update(texture, gray_image(side, side, static_cast<std::uint8_t>(i % 200)));
        store().sync();
        if (i % 100 == 0) context().wait_for_gpu();
    }
    context().wait_for_gpu();
    EXPECT_EQ(live_bytes(), bytes);
    EXPECT_EQ(injector_.live_objects(), objects);
    EXPECT_EQ(red_of(texture), 199);
    EXPECT_EQ(red_of(other), 77);
}

TEST_P(Textures, WorkInFlightKeepsWhatItWasGiven) {
    const TextureRef texture = store().push(gray_image(16, 16, 0));
    store().sync();
    std::vector<Buffer> answers;
    for (uint i = 1; i <= 20; ++i) {
        store().update(texture, gray_image(16 + i % 3, 16, static_cast<std::uint8_t>(i)));
        store().sync();
        answers.push_back(ask(std::vector<TextureQuestion>(500, {texture, 0, 0, vec2(0.5f), 0})));
    }
    for (std::size_t i = 0; i < answers.size(); ++i)
        for (const TextureAnswer& answer : download<TextureAnswer>(context(), answers[i], 500))
            ASSERT_NEAR(255 * answer.color.x, static_cast<float>(i + 1), 0.1f);
}

// The host's commands are recorded with the old texture, and submitted when it has been replaced.
TEST_P(Textures, WhatRecordedCommandsUseOutlivesAnUpdate) {
    test::Caller caller(context());
    const TextureRef texture = store().push(gray_image(8, 8, 50));
    store().sync();
    const CallerCommands late = caller.begin();
    const Buffer answers = [&] {
        Commands commands(context(), "late", late);
        return record_questions(commands, {{texture, 3, 3, vec2(0.5f), 0}});
    }();
    store().update(texture, gray_image(9, 9, 60));
    store().sync();
    EXPECT_EQ(red_of(texture), 60);
    context().wait(Commands(context(), "collects").submit());
    Commands(context(), "collects").submit();
    caller.submit(late);
    context().wait(late.done);
    const TextureAnswer answer = download<TextureAnswer>(context(), answers, 1).front();
    // Buffers are found through the table, which is up to date; descriptors are those that were recorded.
    EXPECT_EQ(answer.size, store().has_images() ? uvec2(8) : uvec2(9));
    EXPECT_EQ(std::lround(255 * answer.texel.x), store().has_images() ? 50 : 60);
}

TEST_P(Textures, ACleanSyncDoesNothing) {
    EXPECT_EQ(store().sync().value, 0u);
    EXPECT_EQ(store().view().count, 0u);
    EXPECT_EQ(store().images(), VkDescriptorSet{});
    store().push(gray_image(1, 1, 1));
    const SyncPoint done = store().sync();
    for (int i = 0; i < 10; ++i) EXPECT_EQ(store().sync().value, done.value);
    EXPECT_EQ(context().last_submission().value, done.value);
}

TEST_P(Textures, SyncsIntoTheCallersCommands) {
    test::Caller caller(context());
    const TextureRef texture = store().push(gray_image(4, 4, 0));
    for (uint frame = 1; frame < 4; ++frame) {
        const SyncPoint last = context().last_submission();
        const CallerCommands buffer = caller.record("frame", [&](Commands& commands) {
            store().update(texture, gray_image(frame < 3 ? 4 : 9, 4, static_cast<std::uint8_t>(frame)));
            store().sync(commands);
        });
        EXPECT_EQ(context().last_submission().value, last.value) << "the store submitted something itself";
        caller.submit(buffer);
        context().wait(buffer.done);
        EXPECT_EQ(red_of(texture), static_cast<long>(frame));
    }
}

TEST_P(Textures, ASyncThatFailsChangesNothingAndTheNextOneWorks) {
    const TextureRef texture = store().push(gray_image(4, 4, 5));
    store().sync();
    std::vector<const char*> functions{"vkCreateBuffer", "vkQueueSubmit"};
    if (store().has_images())
        for (const char* function :
             {"vkCreateImage", "vkCreateImageView", "vkCreateDescriptorPool", "vkAllocateDescriptorSets"})
            functions.push_back(function);
    for (const char* function : functions) {
        context().wait_for_gpu();
        const std::uint64_t revision = store().revision(), bytes = live_bytes();
        const faults::Counts objects = injector_.live_objects();
        store().update(texture, gray_image(5 + static_cast<uint>(revision), 4, 6));
        const TextureRef more = store().push(gray_image(4, 4, 7));
        injector_.inject({.function = function});
        EXPECT_NE(test::error_if_any([&] { store().sync(); }), "") << function;
        EXPECT_EQ(injector_.injected(), 1u) << function;
        injector_.heal();
        EXPECT_EQ(store().revision(), revision);
        context().wait_for_gpu();
        EXPECT_EQ(live_bytes(), bytes) << function;
        EXPECT_EQ(injector_.live_objects(), objects) << function;
        store().sync();
        EXPECT_EQ(red_of(texture), 6);
        EXPECT_EQ(red_of(more), 7);
    }
}

TEST_P(Textures, KernelsAndStoresMustFit) {
    store().push(gray_image(1, 1, 1));
    store().sync();
    const Kernel<test::TextureTestArgs> kernel(
        context(), {.name = "test_texture", .spirv = test_texture_images_spirv, .has_images = true});
    const Kernel<test::TextureTestArgs> without(context(),
                                                {.name = "test_texture", .spirv = test_texture_buffers_spirv});
    Commands commands(context(), "unfit");
    EXPECT_EQ(test::error_if_any([&] { kernel.dispatch(commands, {}, 1); }),
              "kernel 'test_texture': dispatched without images");
    if (!store().has_images()) return;
    EXPECT_EQ(test::error_if_any([&] { without.dispatch(commands, {}, 1, store().images()); }),
              "kernel 'test_texture': it takes no images");
}

}  // namespace
}  // namespace twinray
