// SPDX-License-Identifier: MIT
// Files as bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace twinray::samples {

// Reads the whole file. Throws Error naming it if it does not exist or cannot be read.
std::vector<std::byte> read_file(const std::filesystem::path& file);

// Writes the parts, one after the other, whole or not at all: under another name in the same folder, renamed at the
// end. Throws Error naming the file; an existing file is then unchanged.
void write_file(const std::filesystem::path& file, std::span<const std::span<const std::byte>> parts);

// Returns the CRC-32 of zlib, PNG and gzip. `start`: that of the bytes before.
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t start = 0);

// Returns the extension with its dot, in lower case.
std::string lower_suffix(const std::filesystem::path& file);

}  // namespace twinray::samples
