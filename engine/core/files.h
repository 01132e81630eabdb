// Files as bytes, also compressed ones, text encodings, and folders for files that nobody keeps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
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

// A folder that exists while this object lives. Throws Error if there is no place for one.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace twinray
