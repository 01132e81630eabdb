// SPDX-License-Identifier: MIT
// WebP and AVIF pictures, by libwebp and libavif where twinray was built with them.
#pragma once

#include <span>
#include <string>

#include <twinray/scene.h>

namespace twinray {

enum class Codec : std::uint8_t { none, webp, avif };
// Decided by the first bytes.
Codec codec_of(std::span<const std::uint8_t> bytes);

// Whether this twinray was built with the codec's library.
bool has_library(Codec codec);

// Throws Error naming `object` where the picture is damaged, over 2^28 pixels or of more pixels than its bytes vouch
// for, and where there is no library.
Image decode_by_codec(Codec codec, std::span<const std::uint8_t> bytes, const std::string& object);

}  // namespace twinray
