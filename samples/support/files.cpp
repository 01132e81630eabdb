// SPDX-License-Identifier: MIT
#include "samples/support/files.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <random>
#include <system_error>

#include <zlib.h>

#include "samples/support/text.h"

namespace twinray::samples {
namespace {

constexpr int most_links = 40;  // as Linux follows

// Returns the file that the name refers to, which need not exist yet.
std::filesystem::path linked(std::filesystem::path file) {
    std::error_code error;
    for (int i = 0; i < most_links && std::filesystem::is_symlink(file, error); ++i)
        file = file.parent_path() / std::filesystem::read_symlink(file, error);
    return file;
}

}  // namespace

std::vector<std::byte> read_file(const std::filesystem::path& file) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    if (error) fail("'", file.string(), "': cannot be read: ", error.message());
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::ifstream in(file, std::ios::binary);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!in) fail("'", file.string(), "': read ", in.gcount(), " of ", size, " bytes");
    return bytes;
}

void write_file(const std::filesystem::path& file, std::span<const std::span<const std::byte>> parts) {
    const std::filesystem::path target = linked(file);
    std::filesystem::path partial = target;
    partial += text(".partial-", std::hex, std::random_device{}());
    errno = 0;
    std::ofstream out(partial, std::ios::binary);
    for (const std::span<const std::byte> part : parts)
        out.write(reinterpret_cast<const char*>(part.data()), static_cast<std::streamsize>(part.size()));
    out.close();
    std::error_code error;
    if (out)
        std::filesystem::rename(partial, target, error);
    else
        error = std::error_code(errno, std::generic_category());
    if (!error) return;
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    fail("'", file.string(), "': cannot be written: ", error.message());
}

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t start) {
    return static_cast<std::uint32_t>(crc32_z(start, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string lower_suffix(const std::filesystem::path& file) {
    std::string suffix = file.extension().string();
    std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix;
}

}  // namespace twinray::samples
