// Formats that libraries read and write: OpenEXR, WebP and AVIF.
#include "engine/scene/images.h"

#include <fstream>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <OpenEXRConfig.h>

#ifdef TWINRAY_HAS_WEBP
#include <webp/decode.h>
#endif
#ifdef TWINRAY_HAS_AVIF
#include <avif/avif.h>
#endif

#include "engine/core/error.h"

namespace twinray {
namespace {

// Returns the most bytes of pixels that a byte of a file can become: deflate's 1032, for lines or for the means and
// ends of DWA's 8 x 8 blocks, or 127 for two of a run. Other codecs stay below deflate's.
std::uint64_t most_expansion(Imf::Compression compression) {
    switch (compression) {
        case Imf::NO_COMPRESSION: return 1;
        case Imf::RLE_COMPRESSION: return 64;
        case Imf::DWAA_COMPRESSION:
        case Imf::DWAB_COMPRESSION: return 1u << 15;
        default: return 1u << 11;
    }
}

// Checks a size that only a header gives before memory is taken for it.
void check_pixels_fit(const Imf::Header& header, std::uint64_t pixels, const std::filesystem::path& file) {
    std::uint64_t pixel_bytes = 0;
    for (auto each = header.channels().begin(); each != header.channels().end(); ++each) {
        const Imf::Channel& channel = each.channel();
        const std::uint64_t pixels_a_value = std::uint64_t(channel.xSampling) * std::uint64_t(channel.ySampling);
        pixel_bytes += pixels / pixels_a_value * (channel.type == Imf::HALF ? 2 : 4);
    }
    const std::uint64_t file_bytes = std::filesystem::file_size(file);
    if (pixel_bytes > most_expansion(header.compression()) * file_bytes)
        fail("'", file.string(), "': ", pixels, " pixels are more than its ", file_bytes, " bytes can hold");
}

HdrImage read_pixels(Imf::InputFile& in, const std::filesystem::path& file) {
    const std::string object = file.string();
    const Imath::Box2i window = in.header().dataWindow();
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
    const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
    check_image_size(width, height, object);
    const Imf::ChannelList& channels = in.header().channels();
    const bool is_grey = !channels.findChannel("R") && channels.findChannel("Y");
    if (!is_grey && !(channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B")))
        fail("'", object, "': has neither channels R, G and B nor Y");
    check_pixels_fit(in.header(), static_cast<std::uint64_t>(width * height), file);

    HdrImage image{static_cast<uint>(width), static_cast<uint>(height), {}};
    image.rgb.resize(static_cast<std::size_t>(width * height));
    constexpr std::size_t x_stride = sizeof(vec3);
    const std::size_t y_stride = x_stride * image.width;
    Imf::FrameBuffer frame;
    const std::vector<const char*> names = is_grey ? std::vector{"Y"} : std::vector{"R", "G", "B"};
    for (std::size_t i = 0; i < names.size(); ++i) {
        float* first = &image.rgb[0].x + i;
        frame.insert(names[i], Imf::Slice::Make(Imf::FLOAT, first, window, x_stride, y_stride));
    }
    in.setFrameBuffer(frame);
    in.readPixels(window.min.y, window.max.y);
    if (is_grey)
        for (vec3& pixel : image.rgb) pixel = vec3(pixel.x);
    return image;
}

// Return the windows of the image's pixels and of the whole that they belong to; both include their last pixel.
Imath::Box2i data_window(const HdrImage& image) {
    const HdrImage::Part part = image.part.value_or(HdrImage::Part{});
    const Imath::V2i first(static_cast<int>(part.x), static_cast<int>(part.y));
    return {first, first + Imath::V2i(static_cast<int>(image.width) - 1, static_cast<int>(image.height) - 1)};
}
Imath::Box2i display_window(const HdrImage& image) {
    if (!image.part) return data_window(image);
    const Imath::V2i size(static_cast<int>(image.part->whole_width), static_cast<int>(image.part->whole_height));
    return {Imath::V2i(0, 0), size - Imath::V2i(1, 1)};
}

// Names a method newer than OpenEXR 3.1 (which knows 0 to 9): HTJ2K or ZSTD; empty if the header names another or none.
std::string newer_compression(const std::filesystem::path& file) {
    constexpr std::string_view name("compression\0compression\0", 24);
    constexpr std::size_t header_part = 1 << 16, size_of_length = 4;
    std::string head(header_part, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    const std::size_t at = head.find(name);
    if (at == head.npos || at + name.size() + size_of_length >= head.size()) return "";
    const auto method = static_cast<unsigned char>(head[at + name.size() + size_of_length]);
    if (method < Imf::NUM_COMPRESSION_METHODS) return "";
    return text("its compression method ", int{method}, ", one of the newer HTJ2K and ZSTD, is not known to OpenEXR ",
                OPENEXR_VERSION_STRING, "; save it with ZIP");
}

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

HdrImage load_exr_image(const std::filesystem::path& file) {
    try {
        Imf::InputFile in(file.string().c_str());
        return read_pixels(in, file);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {  // OpenEXR's own, and running out of memory on a false size
        if (const std::string reason = newer_compression(file); !reason.empty())
            fail("'", file.string(), "': ", reason);
        fail("'", file.string(), "': not a readable OpenEXR image (", e.what(), ")");
    }
}

void write_exr_image(const std::filesystem::path& file, const HdrImage& image, std::span<const ImageChannel> channels) {
    try {
        const Imath::Box2i window = data_window(image);
        Imf::Header header(display_window(image), window);
        Imf::FrameBuffer frame;
        const auto insert = [&](const std::string& name, Imf::PixelType type, const void* first, std::size_t stride) {
            header.channels().insert(name, Imf::Channel(type));
            frame.insert(name, Imf::Slice::Make(type, first, window, stride, stride * image.width));
        };
        const char* names[] = {"R", "G", "B"};
        for (int i = 0; i < 3; ++i) insert(names[i], Imf::FLOAT, &image.rgb[0][i], sizeof(vec3));
        for (const ImageChannel& channel : channels)
            std::visit(
                [&](const auto& values) {
                    using Value = typename std::decay_t<decltype(values)>::value_type;
                    insert(channel.name, std::is_same_v<Value, float> ? Imf::FLOAT : Imf::UINT, values.data(),
                           sizeof(Value));
                },
                channel.values);
        Imf::OutputFile out(file.string().c_str(), header);
        out.setFrameBuffer(frame);
        out.writePixels(static_cast<int>(image.height));
    } catch (const std::exception& e) {
        fail("the picture cannot be written (", e.what(), ")");
    }
}

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
