// Pictures in PNG, JPEG, Radiance and OpenEXR; and in WebP and AVIF, made by the libraries that also decode them.
#include <fstream>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
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

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Image decode(const std::string& bytes) { return decode_image(bytes_of(bytes), "picture"); }

TEST(Image, RgbaPngKeepsItsPixelsRowByRow) {
    const Image image = decode(png_bytes(1, 2, 8, 6, "abcdefgh"));
    EXPECT_EQ(image.width, 1u);
    EXPECT_EQ(image.height, 2u);
    EXPECT_EQ(image.rgba, bytes_of("abcdefgh"));
}

TEST(Image, GreyAndRgbAreWidened) {
    EXPECT_EQ(decode(png_bytes(1, 1, 8, 0, "g")).rgba, bytes_of("ggg\xff"));
    EXPECT_EQ(decode(png_bytes(1, 1, 8, 2, "rgb")).rgba, bytes_of("rgb\xff"));
}

TEST(Image, SixteenBitsStay) {
    const Image image = decode(png_bytes(1, 1, 16, 2, "rsgtbu"));
    EXPECT_TRUE(image.rgba.empty());
    EXPECT_EQ(image.rgba16, (std::vector<std::uint16_t>{0x7273, 0x6774, 0x6275, 0xffff}));
}

TEST(Image, WhatCannotBeDecodedIsNamed) {
    const std::string png = png_bytes(4, 4, 8, 6, std::string(64, 'x'));
    expect_error("picture is a damaged PNG", [&] { decode(png.substr(0, png.size() / 2)); });
    expect_error("picture is empty", [] { decode(""); });
    expect_error("picture is a damaged JPEG", [] { decode("\xff\xd8\xff\xe0 nothing"); });
    expect_error("picture is neither PNG nor JPEG", [] { decode("hello"); });
    expect_error("picture is neither PNG nor JPEG",
                 [] { decode("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n1234"); });
}

TEST(Image, AFalseHugeSizeIsRefused) {
    const std::string png = png_bytes(1, 1, 8, 6, "abcd");
    const std::string header = big_endian(100000) + big_endian(100000) + std::string("\x08\x06\0\0\0", 5);
    const std::string huge = png.substr(0, 8) + png_chunk("IHDR", header) + png.substr(33);
    expect_error("picture is a damaged PNG (too large: 100000 x 100000 pixels", [&] { decode(huge); });
}

// stb_image alone refuses each of these inputs as well.
TEST(Image, AHuffmanTableOfMoreCodesThanItsClassHasIsRefused) {
    const auto jpeg = [](const std::string& start, char codes_a_length) {
        return start + std::string("\xff\xc4\x10\x03\0", 5) + std::string(16, codes_a_length) + std::string(4096, '\0');
    };
    expect_error("a Huffman table of 32 codes, more than 17", [&] { decode(jpeg("\xff\xd8", '\2')); });
    expect_error("a Huffman table of 32 codes", [&] { decode(jpeg("\xff\xff\xd8", '\2')); });
    expect_error("a Huffman table is cut off", [&] { decode(jpeg("\xff\xd8", '\1')); });
    expect_error("picture is a damaged JPEG", [&] { decode(jpeg("\xff\xd8", '\0')); });
}

TEST(Image, TheCheckerboardIsMagentaAndBlack) {
    const Image image = checkerboard_image("lost");
    ASSERT_EQ(image.rgba.size(), std::size_t(4) * image.width * image.height);
    EXPECT_EQ(std::vector(image.rgba.begin(), image.rgba.begin() + 4), (std::vector<std::uint8_t>{255, 0, 255, 255}));
    EXPECT_EQ(std::vector(image.rgba.begin() + 16, image.rgba.begin() + 20), (std::vector<std::uint8_t>{0, 0, 0, 255}));
}

TEST(HdrImage, RadianceIsReadAsLinearLight) {
    const TempDir dir;
    const std::string pixels("\x80\x40\x00\x81\x00\x80\x00\x84", 8);  // mantissas and 2^(e - 136)
    const HdrImage image =
        load_hdr_image(dir.write("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + pixels));
    ASSERT_EQ(image.width, 2u);
    ASSERT_EQ(image.height, 1u);
    const float half_step = 0x1p-8f;  // of a pixel whose largest mantissa is worth 1
    EXPECT_EQ(image.rgb[0], vec3(1, 0.5f, 0) + half_step);
    EXPECT_EQ(image.rgb[1], vec3(0, 8, 0) + 8 * half_step);
}

TEST(HdrImage, ABlackRadiancePixelStaysBlack) {
    const TempDir dir;
    const std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string(4, '\0');
    EXPECT_EQ(load_hdr_image(dir.write("a.hdr", file)).rgb[0], vec3(0));
}

TEST(HdrImage, ExposuresAndColourCorrectionsAreDividedOut) {
    const TempDir dir;
    const std::string pixels("\x80\x80\x80\x81", 4);
    const auto pixel = [&](const std::string& lines) {
        return load_hdr_image(
                   dir.write("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n-Y 1 +X 1\n" + pixels))
            .rgb[0];
    };
    const float one = pixel("").x;
    EXPECT_EQ(pixel("EXPOSURE=4.0000e+00\n"), vec3(one / 4));
    EXPECT_EQ(pixel("EXPOSURE=4\nSOFTWARE=x\nEXPOSURE= 0.5\n"), vec3(one / 2));
    EXPECT_EQ(pixel("COLORCORR= 1 2 4\n"), vec3(one, one / 2, one / 4));
    for (const char* nothing : {"EXPOSURE=\n", "EXPOSURE=0\n", "EXPOSURE=nan\n", "COLORCORR=2 2\n"})
        EXPECT_EQ(pixel(nothing), vec3(one)) << nothing;
}

// Stores a row of 8 pixels by runs: each channel has one that repeats a byte 8 times, or one of 8 bytes. A header may
// end with a NUL. Only bytes of the last run are missing, which stb_image takes for zeros.
TEST(HdrImage, RowsOfRunsAreReadWholeOrRefused) {
    const TempDir dir;
    using namespace std::string_literals;
    const std::string runs =
        "\x02\x02\x00\x08\x88\x80\x08"s + std::string(8, '\x40') + "\x88\x00\x08"s + std::string(8, '\x81');
    for (const std::string& line : {"\n"s, "\0\n"s}) {
        const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + line + "-Y 1 +X 8\n";
        EXPECT_EQ(load_hdr_image(dir.write("a.hdr", header + runs)).rgb, std::vector(8, vec3(1, 0.5f, 0) + 0x1p-8f));
        for (std::size_t missing = 1; missing <= 8; ++missing)
            expect_error("its rows are cut off",
                         [&] { load_hdr_image(dir.write("a.hdr", header + runs.substr(0, runs.size() - missing))); });
    }
}

TEST(ImageTest, FilesAreWrittenThroughLinksAndLeaveNothingBesideThem) {
    const TempDir dir;
    const HdrImage image{.width = 1, .height = 1, .rgb = {vec3(1)}};
    std::filesystem::create_directory(dir / "there");
    for (const std::string name : {"a.exr", "a.png"}) {
        std::error_code error;
        std::filesystem::create_symlink("there/" + name, dir / name, error);
        if (error == std::errc::function_not_supported) TWINRAY_LACKS("links", "the C++ library makes no links here");
        for (int i = 0; i < 2; ++i) write_image(dir / name, image, 0, {});
        EXPECT_TRUE(std::filesystem::is_symlink(dir / name));
        EXPECT_TRUE(std::filesystem::is_regular_file(dir / ("there/" + name)));
        expect_error("none/" + name + "'", [&] { write_image(dir / "none" / name, image, 0, {}); });
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dir / "."))
        EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
}

// Writes interleaved floats, as many channels as there are names, with the data window starting at (3, 5).
std::filesystem::path write_exr(const TempDir& dir, const std::vector<std::string>& channels, int width, int height,
                                const std::vector<float>& values, Imf::Compression compression) {
    const std::filesystem::path path = dir / "a.exr";
    const Imath::Box2i window({3, 5}, {3 + width - 1, 5 + height - 1});
    Imf::Header header(window, window);
    header.compression() = compression;
    Imf::FrameBuffer frame;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        header.channels().insert(channels[i], Imf::Channel(Imf::FLOAT));
        const std::size_t x_stride = sizeof(float) * channels.size();
        frame.insert(channels[i], Imf::Slice::Make(Imf::FLOAT, values.data() + i, window, x_stride,
                                                   x_stride * static_cast<std::size_t>(width)));
    }
    Imf::OutputFile file(path.string().c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
    return path;
}

// A reader without the check has room for these sizes.
TEST(HdrImage, MorePixelsThanTheFileCanHoldAreRefused) {
    const TempDir dir;
    const std::string radiance = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n\x80\x40\x01\x81";
    expect_error("4 x 4 pixels are more than its 49 bytes can hold",
                 [&] { load_hdr_image(dir.write("a.hdr", radiance)); });
    const std::vector<float> values(4 * 3, 0.5f);
    const std::string before_window("dataWindow\0box2i\0\x10\0\0\0", 21);
    const std::pair<Imf::Compression, std::string> last_columns[] = {{Imf::NO_COMPRESSION, {"\x3f\0\0\0", 4}},
                                                                     {Imf::RLE_COMPRESSION, {"\xff\x0f\0\0", 4}},
                                                                     {Imf::ZIP_COMPRESSION, {"\xff\xff\3\0", 4}}};
    for (const auto& [compression, last_column] : last_columns) {
        const Bytes bytes = read_file(write_exr(dir, {"R", "G", "B"}, 2, 2, values, compression));
        std::string exr(bytes.begin(), bytes.end());
        exr.replace(exr.find(before_window) + before_window.size() + 8, 4, last_column);  // 4 before
        expect_error("pixels are more than its", [&] { load_hdr_image(dir.write("b.exr", exr)); });
    }
}

// Two of three channels have a value for four pixels.
TEST(HdrImage, ExrOfLuminanceAndSparseColoursIsRead) {
    const TempDir dir;
    const std::filesystem::path file = dir / "a.exr";
    {
        Imf::RgbaOutputFile out(file.string().c_str(), 64, 64, Imf::WRITE_YC, 1, Imath::V2f(0), 1, Imf::INCREASING_Y,
                                Imf::NO_COMPRESSION);
        const std::vector<Imf::Rgba> pixels(64 * 64, Imf::Rgba(0.5f, 0.5f, 0.5f));
        out.setFrameBuffer(pixels.data(), 1, 64);
        out.writePixels(64);
    }
    const HdrImage image = load_hdr_image(file);
    ASSERT_EQ(image.rgb.size(), std::size_t{64 * 64});
    EXPECT_NEAR(image.rgb[0].x, 0.5f, 0.01f);
}

TEST(HdrImage, ExrKeepsFloatsExactly) {
    const TempDir dir;
    const std::vector<float> values = {0.1f, 1e6f, 1e-20f, 3, 4, 5};
    const HdrImage image = load_hdr_image(write_exr(dir, {"R", "G", "B"}, 1, 2, values, Imf::ZIP_COMPRESSION));
    ASSERT_EQ(image.height, 2u);
    EXPECT_EQ(image.rgb[0], vec3(0.1f, 1e6f, 1e-20f));
    EXPECT_EQ(image.rgb[1], vec3(3, 4, 5));
}

TEST(HdrImage, DwabIsRead) {
    const TempDir dir;
    const HdrImage image = load_hdr_image(
        write_exr(dir, {"R", "G", "B"}, 64, 64, std::vector<float>(3 * 64 * 64, 0.5f), Imf::DWAB_COMPRESSION));
    ASSERT_EQ(image.rgb.size(), 4096u);
    for (const vec3& pixel : image.rgb) EXPECT_NEAR(pixel.x, 0.5f, 0.01f);
}

TEST(HdrImage, LuminanceAloneBecomesGrey) {
    const TempDir dir;
    const HdrImage image = load_hdr_image(write_exr(dir, {"Y"}, 2, 1, {2, 7}, Imf::NO_COMPRESSION));
    EXPECT_EQ(image.rgb, (std::vector<vec3>{vec3(2), vec3(7)}));
}

TEST(HdrImage, WhatCannotBeLightIsReplaced) {
    const TempDir dir;
    const HdrImage image =
        load_hdr_image(write_exr(dir, {"R", "G", "B"}, 1, 1, {INFINITY, NAN, -1}, Imf::NO_COMPRESSION));
    EXPECT_EQ(image.rgb[0], vec3(65504, 0, 0));
}

TEST(HdrImage, FaultsAreNamed) {
    const TempDir dir;
    expect_error("no.exr': file not found", [&] { load_hdr_image(dir / "no.exr"); });
    expect_error("unknown suffix '.png'", [&] { load_hdr_image(dir.write("a.png", "x")); });
    expect_error("not a readable OpenEXR image", [&] { load_hdr_image(dir.write("a.exr", "x")); });
    expect_error("not a Radiance .hdr image", [&] { load_hdr_image(dir.write("a.hdr", "x")); });
    const char* upward = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 1 +X 1\nabcd";
    expect_error("'-Y HEIGHT +X WIDTH'", [&] { load_hdr_image(dir.write("a.hdr", upward)); });
    expect_error("neither channels R, G and B nor Y",
                 [&] { load_hdr_image(write_exr(dir, {"Z"}, 1, 1, {1}, Imf::NO_COMPRESSION)); });
}

TEST(HdrImage, ANewerCompressionOfOpenExrIsNamed) {
    const TempDir dir;
    const std::filesystem::path file = write_exr(dir, {"R", "G", "B"}, 1, 1, {1, 2, 3}, Imf::ZIP_COMPRESSION);
    std::string bytes = [&] {
        std::ifstream in(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    }();
    const std::string name("compression\0compression\0", 24);
    bytes[bytes.find(name) + name.size() + 4] = 77;
    const std::string error = error_of([&] { load_hdr_image(dir.write("new.exr", bytes)); });
    expect_contains(error, "compression method 77, one of the newer HTJ2K and ZSTD");
    expect_contains(error, "save it with ZIP");
}

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
