// SPDX-License-Identifier: MIT
// Compressed files and text encodings as bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/core/files.h"

namespace twinray {

// Returns the CRC-32 of zlib, PNG and gzip: it finds all errors within 32 neighbouring bits. `start`: of earlier bytes.
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t start = 0);

// Unpacks gzip data; `object` names its source in errors (damaged, truncated, more than 4 GiB unpacked).
Bytes unpack_gzip(const Bytes& packed, const std::string& object);

// Reads the whole file, and unpacks it if its suffix is .gz.
Bytes read_packed_file(const std::filesystem::path& file);

// Decodes base64 of data URIs (padding optional); returns nothing for a foreign character.
std::optional<Bytes> decode_base64(std::string_view base64);

// Converts %20 to a space and so on; a percent sign without two hexadecimal digits stays.
std::string decode_percent(std::string_view uri);

// Returns the extension with its dot, in lower case.
std::string lower_suffix(const std::filesystem::path& file);

}  // namespace twinray
