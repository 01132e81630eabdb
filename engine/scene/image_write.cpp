#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/scene/images.h"
#include "twinray/glsl/cpp.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace twinray {
namespace {

float luminance(vec3 color) { return dot(color, vec3(0.2126f, 0.7152f, 0.0722f)); }

// Khronos PBR Neutral (2024): leaves values below 0.8 alone, apart from undoing the glare of a dielectric's Fresnel
// reflection, and compresses highlights towards white.
vec3 tone_mapped(vec3 color) {
    constexpr float fresnel = 0.04f, start = 0.8f - fresnel, desaturation = 0.15f;
    const float low = std::min({color.x, color.y, color.z});
    color -= low < 2 * fresnel ? low - low * low / (4 * fresnel) : fresnel;
    const float peak = std::max({color.x, color.y, color.z});
    if (peak < start) return color;
    const float room = 1 - start, compressed = 1 - room * room / (peak + room - start);
    const float white = 1 - 1 / (desaturation * (peak - compressed) + 1);
    return color * (compressed / peak) * (1 - white) + vec3(compressed) * white;
}

void write_exposed(const std::filesystem::path& file, const HdrImage& image, float exposure) {
    const float scale = std::exp2(exposure);
    std::vector<Rgb> pixels;
    pixels.reserve(image.rgb.size());
    for (const vec3& pixel : image.rgb) pixels.push_back(rgb_of_linear(tone_mapped(pixel * scale)));
    write_png(file, image.width, image.height, pixels);
}

}  // namespace

// Converts between sRGB and linear light: IEC 61966-2-1.
float linear_of_srgb(float encoded) {
    const float c = std::clamp(encoded, 0.0f, 1.0f);
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}
float srgb_of_linear(float linear) {
    const float c = linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
    return std::clamp(c, 0.0f, 1.0f);
}

vec3 linear_of(Rgb color) {
    return {linear_of_srgb(static_cast<float>(color.r) / 255), linear_of_srgb(static_cast<float>(color.g) / 255),
            linear_of_srgb(static_cast<float>(color.b) / 255)};
}

Rgb rgb_of_linear(vec3 linear) {
    const auto byte = [](float value) { return static_cast<std::uint8_t>(std::lround(srgb_of_linear(value) * 255)); };
    return {byte(linear.x), byte(linear.y), byte(linear.z)};
}

float automatic_exposure(const HdrImage& image) {
    double sum = 0;
    std::size_t count = 0;
    for (const vec3& pixel : image.rgb)
        if (const float l = luminance(pixel); l > 0) {
            sum += std::log2(double{l});
            ++count;
        }
    return count ? static_cast<float>(std::log2(0.18) - sum / static_cast<double>(count)) : 0;
}

bool is_image_file(const std::filesystem::path& file) {
    return lower_suffix(file) == ".png" || lower_suffix(file) == ".exr";
}

void write_image(const std::filesystem::path& file, const HdrImage& image, float exposure,
                 std::span<const ImageChannel> channels) {
    if (lower_suffix(file) != ".exr") return write_exposed(file, image, exposure);
    write_whole(file, [&](const std::filesystem::path& partial) {
        try {
            write_exr_image(partial, image, channels);
        } catch (const Error& error) {
            fail("'", file.string(), "': ", error.what());
        }
    });
}

std::vector<std::byte> encode_png(uint width, uint height, std::span<const Rgb> pixels) {
    const auto take = [](void* bytes, void* data, int size) {  // must not throw: stb would leak what it has encoded
        const auto* begin = static_cast<const std::byte*>(data);
        static_cast<std::vector<std::byte>*>(bytes)->assign(begin, begin + size);
    };
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    std::vector<std::byte> encoded;
    if (stbi_write_png_to_func(take, &encoded, w, h, 3, pixels.data(), 3 * w) == 0)
        fail("a picture of ", width, " x ", height, " pixels cannot be encoded");
    return encoded;
}

void write_png(const std::filesystem::path& file, uint width, uint height, std::span<const Rgb> pixels) {
    const std::vector<std::byte> encoded = encode_png(width, height, pixels);
    const std::span<const std::byte> whole = encoded;
    write_file(file, std::span(&whole, 1));
}

}  // namespace twinray
