#include <algorithm>

#include <glm/gtc/packing.hpp>

#include "engine/core/error.h"
#include "engine/scene/images.h"
#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/half.h"
#include "twinray/glsl/cpp_end.h"

namespace {

template <class T>
T read_as(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

double read_number(TexelFormat format, const std::byte* at) {
    switch (format) {
        case TexelFormat::unorm8: return read_as<std::uint8_t>(at) / 255.0;
        case TexelFormat::unorm16: return read_as<std::uint16_t>(at) / 65535.0;
        case TexelFormat::float16: return float_of_half(read_as<std::uint16_t>(at));
        case TexelFormat::float32: break;
    }
    return read_as<float>(at);
}

template <class T>
void write_as(std::byte* at, T value) {
    std::memcpy(at, &value, sizeof value);
}

void write_number(TexelFormat format, std::byte* at, double value) {
    switch (format) {
        case TexelFormat::unorm8: return write_as(at, static_cast<std::uint8_t>(std::lround(value * 255)));
        case TexelFormat::unorm16: return write_as(at, static_cast<std::uint16_t>(std::lround(value * 65535)));
        case TexelFormat::float16: return write_as(at, glm::packHalf1x16(static_cast<float>(value)));
        case TexelFormat::float32: return write_as(at, static_cast<float>(value));
    }
}

// Convert between sRGB and linear light by IEC 61966-2-1, in float64.
double linear_number(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
double srgb_number(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// The texels of one axis of the larger level that one texel of the smaller level covers.
struct Cover {
    double from, to;
    double of(uint texel) const { return std::min(to, texel + 1.0) - std::max(from, double(texel)); }
    uint first() const { return static_cast<uint>(from); }
    uint end() const { return static_cast<uint>(std::ceil(to)); }
};
Cover cover(uint texel, uint smaller, uint larger) {
    const double each = double(larger) / smaller;
    return {texel * each, std::min((texel + 1) * each, double(larger))};
}

class Halving {
  public:
    Halving(const Texels& texels, bool is_srgb) : texels_(texels), is_srgb_(is_srgb) {}

    std::vector<std::byte> below(std::size_t level) const {
        const TexelSize large = level_size(texels_, level), small = level_size(texels_, level + 1);
        std::vector<std::byte> made(std::size_t{small.width} * small.height * texel_bytes(texels_));
        std::byte* next = made.data();
        for (uint y = 0; y < small.height; ++y)
            for (uint x = 0; x < small.width; ++x)
                for (uint channel = 0; channel < texels_.channels; ++channel) {
                    const double mean = this->mean(level, cover(x, small.width, large.width),
                                                   cover(y, small.height, large.height), channel);
                    write_number(texels_.format, next, is_coded(channel) ? srgb_number(mean) : mean);
                    next += bytes_of(texels_.format);
                }
        return made;
    }

  private:
    bool is_coded(uint channel) const { return is_srgb_ && channel < 3; }

    double mean(std::size_t level, const Cover& across, const Cover& down, uint channel) const {
        const std::size_t width = level_size(texels_, level).width;
        double sum = 0;
        for (uint y = down.first(); y < down.end(); ++y)
            for (uint x = across.first(); x < across.end(); ++x) {
                const std::size_t at = (y * width + x) * texel_bytes(texels_) + channel * bytes_of(texels_.format);
                const double number = read_number(texels_.format, &texels_.levels[level][at]);
                sum += (is_coded(channel) ? linear_number(number) : number) * across.of(x) * down.of(y);
            }
        return sum / ((across.to - across.from) * (down.to - down.from));
    }

    const Texels& texels_;
    bool is_srgb_;
};

}  // namespace

TexelSize level_size(const Texels& texels, std::size_t level) {
    return {std::max(texels.width >> level, 1u), std::max(texels.height >> level, 1u)};
}

std::size_t texel_bytes(const Texels& texels) { return std::size_t{texels.channels} * bytes_of(texels.format); }

void check_texels(const Texels& texels, const std::string& object) {
    const std::string it = text(object, ": image '", texels.name, "' of ", texels.width, " x ", texels.height);
    if (texels.channels < 1 || texels.channels > 4) fail(it, " has ", texels.channels, " channels; 1 to 4 fit");
    constexpr std::uint64_t most_bytes = ~0u;  // that kernels find a texel among
    if (std::uint64_t{texels.width} * texels.height > most_bytes / texel_bytes(texels))
        fail(it, " has a level of more than 4 GiB");
    const std::size_t most = std::bit_width(std::max(texels.width, texels.height));
    if (texels.width == 0 || texels.height == 0 || texels.levels.empty())
        fail(it, " has no texels; it needs at least one");
    if (texels.levels.size() > most)
        fail(it, " has ", texels.levels.size(), " levels; at most ", most, " are possible");
    for (std::size_t level = 0; level < texels.levels.size(); ++level) {
        const TexelSize size = level_size(texels, level);
        const std::size_t bytes = std::size_t{size.width} * size.height * texel_bytes(texels);
        if (texels.levels[level].size() != bytes)
            fail(it, " has ", texels.levels[level].size(), " bytes in level ", level, "; it needs ", bytes);
    }
}

bool is_alike(const Texels& a, const Texels& b) {
    return a.width == b.width && a.height == b.height && a.channels == b.channels && a.format == b.format &&
           a.levels.size() == b.levels.size();
}

Texels Texels::of(const Image& image) {
    if (!image.rgba16.empty())
        return of(image.name, image.width, image.height, 4, TexelFormat::unorm16,
                  std::span<const std::uint16_t>(image.rgba16));
    return of(image.name, image.width, image.height, 4, TexelFormat::unorm8, std::span<const std::uint8_t>(image.rgba));
}

Image checkerboard_image(const std::string& name) {
    constexpr uint size = 32, square = 4;
    Image image{.name = name, .width = size, .height = size, .rgba = {}, .is_placeholder = true};
    for (uint y = 0; y < size; ++y)
        for (uint x = 0; x < size; ++x) {
            const std::uint8_t value = (x / square + y / square) % 2 == 0 ? 255 : 0;
            image.rgba.insert(image.rgba.end(), {value, 0, value, 255});
        }
    return image;
}

Texels with_mipmaps(Texels texels, bool is_srgb) {
    check_texels(texels, "with_mipmaps");
    texels.levels.resize(1);
    const Halving halving(texels, is_srgb);
    while (texels.levels.size() < static_cast<std::size_t>(std::bit_width(std::max(texels.width, texels.height))))
        texels.levels.push_back(halving.below(texels.levels.size() - 1));
    return texels;
}

Texels widened(Texels texels) {
    const std::size_t before = texel_bytes(texels), number = bytes_of(texels.format);
    std::array<std::byte, 16> empty{};
    write_number(texels.format, &empty[3 * number], 1);
    for (std::vector<std::byte>& level : texels.levels) {
        std::vector<std::byte> wide(level.size() / before * 4 * number);
        for (std::size_t i = 0; i < level.size() / before; ++i) {
            std::byte* at = &wide[i * 4 * number];
            std::memcpy(at, empty.data(), 4 * number);
            std::memcpy(at, &level[i * before], before);
        }
        level = std::move(wide);
    }
    texels.channels = 4;
    return texels;
}

Texels decoded_srgb16(Texels texels) {
    for (std::vector<std::byte>& level : texels.levels)
        for (std::size_t i = 0; i < level.size() / 2; ++i)
            if (i % texels.channels < 3)
                write_number(TexelFormat::unorm16, &level[2 * i],
                             linear_number(read_number(TexelFormat::unorm16, &level[2 * i])));
    return texels;
}

}  // namespace twinray
