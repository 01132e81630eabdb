// SPDX-License-Identifier: MIT
#include "samples/path_tracer/image_io.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "engine/scene/png.h"

namespace twinray::path_tracer {
namespace {

// Khronos PBR Neutral (2024): leaves what is below 0.8 alone, apart from undoing the glare of a dielectric's Fresnel
// reflection, and compresses highlights towards white.
vec3 tone_mapped(vec3 color) {
    constexpr float fresnel = 0.04f, start = 0.8f - fresnel, desaturation = 0.15f;
    const float low = std::min({color.x, color.y, color.z});
    color -= low < 2 * fresnel ? low - low * low / (4 * fresnel) : fresnel;
    const float peak = largest(color);
    if (peak < start) return color;
    const float room = 1 - start, compressed = 1 - room * room / (peak + room - start);
    return glm::mix(color * (compressed / peak), vec3(compressed), 1 - 1 / (desaturation * (peak - compressed) + 1));
}

void write_exposed(const std::filesystem::path& file, const Picture& picture, float exposure) {
    const float scale = std::exp2(exposure);
    std::vector<Rgb> pixels;
    pixels.reserve(picture.rgb.size());
    for (const vec3& pixel : picture.rgb) pixels.push_back(rgb_of_linear(tone_mapped(pixel * scale)));
    write_png(file, picture.width, picture.height, pixels);
}

void write_exr(const std::filesystem::path& file, const Picture& picture, std::span<const Channel> layers) {
    try {
        Imf::Header header(static_cast<int>(picture.width), static_cast<int>(picture.height));
        Imf::FrameBuffer frame;
        const char* names[] = {"R", "G", "B"};
        for (std::size_t i = 0; i < 3; ++i) {
            header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
            // The library takes pointers to non-const for reading and writing alike.
            char* first = const_cast<char*>(reinterpret_cast<const char*>(picture.rgb.data())) + i * sizeof(float);
            frame.insert(names[i], Imf::Slice(Imf::FLOAT, first, sizeof(vec3), sizeof(vec3) * picture.width));
        }
        for (const Channel& layer : layers)
            std::visit(
                [&](const auto& values) {
                    using Value = typename std::decay_t<decltype(values)>::value_type;
                    const Imf::PixelType type = std::is_same_v<Value, float> ? Imf::FLOAT : Imf::UINT;
                    header.channels().insert(layer.name, Imf::Channel(type));
                    char* first = const_cast<char*>(reinterpret_cast<const char*>(values.data()));
                    frame.insert(layer.name, Imf::Slice(type, first, sizeof(Value), sizeof(Value) * picture.width));
                },
                layer.values);
        Imf::OutputFile out(file.string().c_str(), header);
        out.setFrameBuffer(frame);
        out.writePixels(static_cast<int>(picture.height));
    } catch (const std::exception& e) {
        fail("'", file.string(), "': cannot write the picture (", e.what(), ")");
    }
}

}  // namespace

float automatic_exposure(const Picture& picture) {
    double sum = 0;
    std::size_t count = 0;
    for (const vec3& pixel : picture.rgb)
        if (const float l = luminance(pixel); l > 0) {
            sum += std::log2(double{l});
            ++count;
        }
    return count ? static_cast<float>(std::log2(0.18) - sum / static_cast<double>(count)) : 0;
}

bool is_picture_file(const std::filesystem::path& file) {
    return lower_suffix(file) == ".png" || lower_suffix(file) == ".exr";
}

void write_picture(const std::filesystem::path& file, const Picture& picture, float exposure,
                   std::span<const Channel> layers) {
    std::filesystem::path partial = file;
    partial += text(".partial-", std::hex, std::random_device{}());
    if (lower_suffix(file) == ".exr")
        write_exr(partial, picture, layers);
    else
        write_exposed(partial, picture, exposure);
    std::error_code error;
    std::filesystem::rename(partial, file, error);
    if (error) fail("'", file.string(), "': cannot be written: ", error.message());
}

}  // namespace twinray::path_tracer
