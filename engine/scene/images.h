// Files of images in the formats that twinray reads and writes, the image that replaces a missing one, and texels on
// the host: sizes, widening, mipmaps.
#pragma once

#include <cstddef>

#include <twinray/scene.h>

namespace twinray {

// WebP and AVIF pictures, by libwebp and libavif where twinray was built with them.
enum class Codec : std::uint8_t { none, webp, avif };
// Returns the codec, decided by the first bytes.
Codec codec_of(std::span<const std::uint8_t> bytes);

// Returns whether this twinray was built with the codec's library.
bool has_library(Codec codec);

// Throws Error naming `object` where the picture is damaged, over 2^28 pixels or of more pixels than its bytes vouch
// for, and where there is no library.
Image decode_by_codec(Codec codec, std::span<const std::uint8_t> bytes, const std::string& object);

// Returns the pixels of an OpenEXR file as stored. Throws Error naming the file.
HdrImage load_exr_image(const std::filesystem::path& file);

// Writes linear 32-bit float, and channels beside them; a part of an image as the data window of the whole's display
// window. Throws Error that says why it cannot.
void write_exr_image(const std::filesystem::path& file, const HdrImage& image, std::span<const ImageChannel> channels);

// Throws Error naming `object` if an image of this size is empty or over 2^28 pixels, beyond which a file is more
// likely damaged than meant.
void check_image_size(std::int64_t width, std::int64_t height, const std::string& object);

// Returns a PNG file in memory. `pixels`: width * height of them, row 0 on top.
std::vector<std::byte> encode_png(uint width, uint height, std::span<const Rgb> pixels);

// Returns magenta and black squares, which replace an image that cannot be shown, so that nobody overlooks it.
Image checkerboard_image(const std::string& name);

struct TexelSize {
    uint width, height;
};
// Returns the size of a level: half as wide and high as the one before, at least 1.
TexelSize level_size(const Texels& texels, std::size_t level);
std::size_t texel_bytes(const Texels& texels);  // of one texel

// Throws Error naming `object`, the texels and what does not fit: channels, the number of levels, the bytes of one.
void check_texels(const Texels& texels, const std::string& object);
// Returns whether one may use the memory of the other.
bool is_alike(const Texels& a, const Texels& b);
// Returns the texels with four channels.
Texels widened(Texels texels);
// Converts unorm16 of sRGB to unorm16 of linear light; alpha stays as it is.
Texels decoded_srgb16(Texels texels);

}  // namespace twinray
