// SPDX-License-Identifier: MIT
// Pictures in WebP and AVIF, made by the libraries that also decode them.
#include <gtest/gtest.h>

#include "engine/scene/images.h"
#include "tests/scene/gltf_builder.h"
#include "tests/support/device.h"

#ifdef TWINRAY_HAS_WEBP
#include <webp/encode.h>
#endif
#ifdef TWINRAY_HAS_AVIF
#include <avif/avif.h>
#endif

namespace twinray::test {
namespace {

const std::vector<std::uint8_t> TEXELS = {255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 255, 10, 20, 30, 255};  // 2 x 2

std::span<const std::uint8_t> span_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

#ifdef TWINRAY_HAS_WEBP
std::string webp_file(int width, int height, const std::vector<std::uint8_t>& texels) {
    std::uint8_t* data = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(texels.data(), width, height, 4 * width, &data);
    std::string file(reinterpret_cast<const char*>(data), size);
    WebPFree(data);
    return file;
}

TEST(ImageCodecs, WebpIsDecoded) {
    const Image image = decode_image(span_of(webp_file(2, 2, TEXELS)), "w");
    EXPECT_EQ(image.width, 2u);
    EXPECT_EQ(image.rgba, TEXELS);
}

TEST(ImageCodecs, ADamagedWebpIsNamed) {
    const std::string whole = webp_file(2, 2, TEXELS);
    expect_error("w is a damaged WebP", [&] { decode_image(span_of(whole.substr(0, 16)), "w"); });
    expect_error("w is a damaged WebP", [&] { decode_image(span_of(whole.substr(0, whole.size() - 8)), "w"); });
}

TEST(ImageCodecs, MorePixelsThanAWebpsBytesVouchForAreRefused) {
    constexpr int side = 8000;
    const std::string file = webp_file(side, side, std::vector<std::uint8_t>(std::size_t{4} * side * side, 255));
    expect_error("8000 x 8000 pixels are more than its", [&] { decode_image(span_of(file), "w"); });
}

TEST(ImageCodecs, ARequiredWebpTextureIsShown) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["attributes"]["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
    gltf.root["images"] = {{{"bufferView", gltf.add_view(webp_file(2, 2, TEXELS))}, {"mimeType", "image/webp"}}};
    gltf.root["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
    gltf.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    gltf.primitive()["material"] = 0;
    gltf.root["extensionsRequired"] = gltf.root["extensionsUsed"] = {"EXT_texture_webp"};
    const Scene scene = gltf.load();
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].rgba, TEXELS);
}
#endif

#ifdef TWINRAY_HAS_AVIF
// Returns "" if this libavif encodes nothing.
template <class T>
std::string avif_file(std::uint32_t depth, std::vector<T> texels) {
    avifImage* image = avifImageCreate(2, 2, static_cast<int>(depth), AVIF_PIXEL_FORMAT_YUV444);
    avifRGBImage rgb;
    avifRGBImageSetDefaults(&rgb, image);
    rgb.depth = 8 * sizeof(T);
    rgb.pixels = reinterpret_cast<std::uint8_t*>(texels.data());
    rgb.rowBytes = 8 * sizeof(T);
    EXPECT_EQ(avifImageRGBToYUV(image, &rgb), AVIF_RESULT_OK);
    avifEncoder* encoder = avifEncoderCreate();
    encoder->minQuantizer = encoder->maxQuantizer = AVIF_QUANTIZER_LOSSLESS;
    avifRWData output = AVIF_DATA_EMPTY;
    const avifResult written = avifEncoderWrite(encoder, image, &output);
    const std::string file(reinterpret_cast<const char*>(output.data), output.size);
    avifRWDataFree(&output);
    avifEncoderDestroy(encoder);
    avifImageDestroy(image);
    return written == AVIF_RESULT_OK ? file : "";
}

TEST(ImageCodecs, AvifIsDecoded) {
    const std::string file = avif_file(8, TEXELS);
    if (file.empty()) TWINRAY_LACKS("avif", "this libavif encodes nothing");
    const Image decoded = decode_image(span_of(file), "a");
    ASSERT_EQ(decoded.rgba.size(), TEXELS.size());
    for (std::size_t i = 0; i < TEXELS.size(); ++i) EXPECT_NEAR(decoded.rgba[i], TEXELS[i], 8) << i;
    expect_error("a is a damaged AVIF", [&] { decode_image(span_of(file.substr(0, file.size() / 2)), "a"); });
}

TEST(ImageCodecs, AnAvifOfTenBitsKeepsThem) {
    const std::vector<std::uint16_t> texels(16, 0x4040);
    const std::string file = avif_file(10, texels);
    if (file.empty()) TWINRAY_LACKS("avif", "this libavif encodes nothing");
    const Image decoded = decode_image(span_of(file), "a");
    ASSERT_EQ(decoded.rgba16.size(), texels.size());
    for (std::size_t i = 0; i < texels.size(); ++i) EXPECT_NEAR(decoded.rgba16[i], texels[i], 128) << i;
}
#endif

TEST(ImageCodecs, WhatNoLibraryDecodesIsNamedWithTheRemedy) {
    for (const Codec codec : {Codec::webp, Codec::avif})
        if (!has_library(codec))
            expect_error("gltf-transform png --formats '*'", [&] { decode_by_codec(codec, {}, "w"); });
    EXPECT_EQ(codec_of(span_of(std::string("RIFF\1\1\1\1WEBP"))), Codec::webp);
    EXPECT_EQ(codec_of(span_of(std::string("\1\1\1\1ftypavif"))), Codec::avif);
    EXPECT_EQ(codec_of(span_of("\x89PNG")), Codec::none);
}

}  // namespace
}  // namespace twinray::test
