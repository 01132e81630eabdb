// SPDX-License-Identifier: MIT
// Texels on the host: sizes, widening, mipmaps. Pure functions.
#pragma once

#include <twinray/scene.h>

namespace twinray {

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
