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
    return mix(color * (compressed / peak), vec3(compressed), 1 - 1 / (desaturation * (peak - compressed) + 1));
}

void write_exposed(const std::filesystem::path& file, const Picture& picture, float exposure) {
    const float scale = std::exp2(exposure);
    std::vector<Rgb> pixels;
    pixels.reserve(picture.rgb.size());
    for (const vec3& pixel : picture.rgb) pixels.push_back(rgb_of_linear(tone_mapped(pixel * scale)));
    write_png(file, picture.width, picture.height, pixels);
}

// Of the pixels that a picture has, and of the whole that they are of; both with their last pixel.
Imath::Box2i data_window(const Picture& picture) {
    const PicturePart part = picture.part.value_or(PicturePart{});
    const Imath::V2i first(static_cast<int>(part.x), static_cast<int>(part.y));
    return {first, first + Imath::V2i(static_cast<int>(picture.width) - 1, static_cast<int>(picture.height) - 1)};
}
Imath::Box2i display_window(const Picture& picture) {
    if (!picture.part) return data_window(picture);
    const Imath::V2i size(static_cast<int>(picture.part->whole_width), static_cast<int>(picture.part->whole_height));
    return {Imath::V2i(0, 0), size - Imath::V2i(1, 1)};
}

void write_exr(const std::filesystem::path& file, const Picture& picture, std::span<const Channel> layers) {
    try {
        const Imath::Box2i window = data_window(picture);
        Imf::Header header(display_window(picture), window);
        Imf::FrameBuffer frame;
        const auto insert = [&](const std::string& name, Imf::PixelType type, const void* first, std::size_t stride) {
            header.channels().insert(name, Imf::Channel(type));
            frame.insert(name, Imf::Slice::Make(type, first, window, stride, stride * picture.width));
        };
        const char* names[] = {"R", "G", "B"};
        for (int i = 0; i < 3; ++i) insert(names[i], Imf::FLOAT, &picture.rgb[0][i], sizeof(vec3));
        for (const Channel& layer : layers)
            std::visit(
                [&](const auto& values) {
                    using Value = typename std::decay_t<decltype(values)>::value_type;
                    insert(layer.name, std::is_same_v<Value, float> ? Imf::FLOAT : Imf::UINT, values.data(),
                           sizeof(Value));
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
