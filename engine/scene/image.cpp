// SPDX-License-Identifier: MIT
#include <twinray/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "engine/scene/image_checks.h"
#include "engine/scene/image_exr.h"

// A private copy of stb_image, with only the decoders that we offer to untrusted files.
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

struct FreePixels {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

std::string damaged(const char* format) {
    const char* reason = stbi_failure_reason();
    return text("a damaged ", format, " (", reason ? reason : "unknown reason", ")");
}

// Names what an undecodable image is, since "unknown format" helps nobody.
std::string description_of(std::span<const std::uint8_t> bytes) {
    using namespace std::string_view_literals;
    const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 16));
    if (head.empty()) return "empty";
    if (head.starts_with("\x89PNG"sv)) return damaged("PNG");
    if (head.starts_with("\xff\xd8\xff"sv)) return damaged("JPEG");
    if (head.starts_with("\xabKTX 20"sv)) return "a KTX2 (Basis) texture, which is not supported; convert it to PNG";
    if (head.starts_with("RIFF"sv) && head.substr(8).starts_with("WEBP"sv))
        return "a WebP image, which is not supported; convert it to PNG";
    if (head.starts_with("DDS "sv)) return "a DDS texture, which is not supported; convert it to PNG";
    return "neither PNG nor JPEG";
}

int checked_size(std::span<const std::uint8_t> bytes, const std::string& object) {
    if (bytes.size() > INT32_MAX) fail("'", object, "': image data over 2 GiB");
    return static_cast<int>(bytes.size());
}

// Into four channels, by stb's function for numbers of T.
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
    if (!stbi_is_hdr_from_memory(bytes.data(), size) ||
        !stbi_info_from_memory(bytes.data(), size, &width, &height, &channels))
        fail("'", object, "': not a Radiance .hdr image");
    check_image_size(width, height, object);
    if (!can_hold_radiance(bytes.size(), static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height)))
        fail("'", object, "': damaged Radiance .hdr image (", width, " x ", height, " pixels are more than its ",
             bytes.size(), " bytes can hold)");
    if (!has_whole_runs(bytes, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height)))
        fail("'", object, "': damaged Radiance .hdr image (its rows are cut off)");
    const std::unique_ptr<float, FreePixels> pixels(
        stbi_loadf_from_memory(bytes.data(), size, &width, &height, &channels, 3));
    if (!pixels) fail("'", object, "': damaged Radiance .hdr image (", stbi_failure_reason(), ")");
    HdrImage image{static_cast<uint>(width), static_cast<uint>(height), {}};
    image.rgb.resize(std::size_t(image.width) * image.height);
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        image.rgb[i] = vec3(pixels.get()[3 * i], pixels.get()[3 * i + 1], pixels.get()[3 * i + 2]);
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
