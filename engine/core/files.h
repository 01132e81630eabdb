// SPDX-License-Identifier: MIT
// Files as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace twinray {

using Bytes = std::vector<std::uint8_t>;

// Reads the whole file. Throws Error naming it if it is missing, not a regular file or unreadable.
Bytes read_file(const std::filesystem::path& file);

// Makes the file whole or not at all: `write` makes it under another name in the same folder, and it is renamed at the
// end. A symbolic link is followed; a file that is not regular, such as a pipe, is written directly. Throws Error
// naming the file, or what `write` throws; an existing file is then unchanged.
void write_whole(const std::filesystem::path& file, const std::function<void(const std::filesystem::path&)>& write);

// Writes the pieces, one after the other, by write_whole().
void write_file(const std::filesystem::path& file, std::span<const std::span<const std::byte>> pieces);
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace twinray
