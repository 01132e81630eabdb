// SPDX-License-Identifier: MIT
#include "engine/scene/images.h"

#include <memory>
#include <string_view>

#include "engine/core/error.h"

#ifdef TWINRAY_HAS_WEBP
#include <webp/decode.h>
#endif
#ifdef TWINRAY_HAS_AVIF
#include <avif/avif.h>
#endif

namespace twinray {
namespace {

using namespace std::string_view_literals;

#if defined(TWINRAY_HAS_WEBP) || defined(TWINRAY_HAS_AVIF)
// A picture of one colour takes a few bytes, whatever its size.
void check_codec_pixels(std::int64_t width, std::int64_t height, std::size_t bytes, const std::string& object) {
    constexpr std::int64_t of_no_bytes = std::int64_t{1} << 24, of_a_byte = 1 << 12;
    check_image_size(width, height, object);
    if (width * height - of_no_bytes > of_a_byte * static_cast<std::int64_t>(bytes))
        fail("'", object, "': ", width, " x ", height, " pixels are more than its ", bytes, " bytes can hold");
}
#endif

#ifdef TWINRAY_HAS_WEBP
Image decode_webp(std::span<const std::uint8_t> bytes, const std::string& object) {
    int width = 0, height = 0;
    if (!WebPGetInfo(bytes.data(), bytes.size(), &width, &height)) fail(object, " is a damaged WebP");
    check_codec_pixels(width, height, bytes.size(), object);
    Image image{object, static_cast<uint>(width), static_cast<uint>(height), {}};
    image.rgba.resize(std::size_t{4} * image.width * image.height);
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba.data(), image.rgba.size(), 4 * width))
        fail(object, " is a damaged WebP, or one that moves");
    return image;
}
#endif

#ifdef TWINRAY_HAS_AVIF
void check_avif(avifResult result, const std::string& object) {
    if (result != AVIF_RESULT_OK) fail(object, " is a damaged AVIF (", avifResultToString(result), ")");
}

template <class T>
void convert_avif(const avifImage& source, avifRGBImage& rgb, std::vector<T>& texels, const std::string& object) {
    texels.resize(std::size_t{4} * source.width * source.height);
    rgb.format = AVIF_RGB_FORMAT_RGBA;
    rgb.depth = 8 * sizeof(T);
    rgb.pixels = reinterpret_cast<std::uint8_t*>(texels.data());
    rgb.rowBytes = static_cast<std::uint32_t>(4 * sizeof(T) * source.width);
    check_avif(avifImageYUVToRGB(&source, &rgb), object);
}

Image decode_avif(std::span<const std::uint8_t> bytes, const std::string& object) {
    const std::unique_ptr<avifDecoder, decltype(&avifDecoderDestroy)> decoder(avifDecoderCreate(), &avifDecoderDestroy);
    if (!decoder) fail(object, ": libavif has no memory for a decoder");
    check_avif(avifDecoderSetIOMemory(decoder.get(), bytes.data(), bytes.size()), object);
    check_avif(avifDecoderParse(decoder.get()), object);
    check_codec_pixels(decoder->image->width, decoder->image->height, bytes.size(), object);
    check_avif(avifDecoderNextImage(decoder.get()), object);
    const avifImage& source = *decoder->image;
    check_codec_pixels(source.width, source.height, bytes.size(), object);
    Image image{object, source.width, source.height, {}};
    avifRGBImage rgb;
    avifRGBImageSetDefaults(&rgb, &source);
    source.depth > 8 ? convert_avif(source, rgb, image.rgba16, object) : convert_avif(source, rgb, image.rgba, object);
    return image;
}
#endif

}  // namespace

Codec codec_of(std::span<const std::uint8_t> bytes) {
    const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 12));
    if (head.starts_with("RIFF"sv) && head.substr(8) == "WEBP"sv) return Codec::webp;
    const bool is_avif = head.size() == 12 && (head.substr(4) == "ftypavif"sv || head.substr(4) == "ftypavis"sv ||
                                               head.substr(4) == "ftypmif1"sv);
    return is_avif ? Codec::avif : Codec::none;
}

bool has_library(Codec codec) {
#ifdef TWINRAY_HAS_WEBP
    if (codec == Codec::webp) return true;
#endif
#ifdef TWINRAY_HAS_AVIF
    if (codec == Codec::avif) return true;
#endif
    return codec == Codec::none;
}

Image decode_by_codec(Codec codec, [[maybe_unused]] std::span<const std::uint8_t> bytes, const std::string& object) {
#ifdef TWINRAY_HAS_WEBP
    if (codec == Codec::webp) return decode_webp(bytes, object);
#endif
#ifdef TWINRAY_HAS_AVIF
    if (codec == Codec::avif) return decode_avif(bytes, object);
#endif
    const bool is_webp = codec == Codec::webp;
    fail(object, " is ", is_webp ? "a WebP" : "an AVIF", " picture, and this twinray was built without ",
         is_webp ? "libwebp" : "libavif", "; convert it with `gltf-transform png --formats '*' in.glb out.glb`");
}

}  // namespace twinray
