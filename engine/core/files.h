// SPDX-License-Identifier: MIT
// Files as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace twinray {

using Bytes = std::vector<std::uint8_t>;

// The whole file. Throws Error naming it when it is missing, not a regular file or cannot be read.
Bytes read_file(const std::filesystem::path& file);

// Writes the pieces, one after the other, whole or not at all: under another name in the same folder, renamed at the
// end. Throws Error naming the file; what was there before is then still there.
void write_file(const std::filesystem::path& file, std::span<const std::span<const std::byte>> pieces);

}  // namespace twinray
