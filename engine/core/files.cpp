// SPDX-License-Identifier: MIT
#include "engine/core/files.h"

#include <cerrno>
#include <fstream>
#include <random>
#include <system_error>

#include "engine/core/error.h"

namespace twinray {

Bytes read_file(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) fail("'", file.string(), "': file not found");
    if (!std::filesystem::is_regular_file(status)) fail("'", file.string(), "': not a regular file");
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    const std::streamoff size = in ? std::streamoff(in.tellg()) : -1;
    if (size < 0) fail("'", file.string(), "': cannot be opened; check its permissions");
    Bytes bytes(static_cast<std::size_t>(size));
    in.seekg(0);
    in.read(reinterpret_cast<char*>(bytes.data()), size);
    if (in.gcount() != size) fail("'", file.string(), "': read ", in.gcount(), " of ", size, " bytes");
    return bytes;
}

void write_whole(const std::filesystem::path& file, const std::function<void(const std::filesystem::path&)>& write) {
    std::filesystem::path partial = file;
    partial += text(".partial-", std::hex, std::random_device{}());
    std::error_code error, ignored;
    try {
        write(partial);
        std::filesystem::rename(partial, file, error);
    } catch (...) {
        std::filesystem::remove(partial, ignored);
        throw;
    }
    if (!error) return;
    std::filesystem::remove(partial, ignored);
    fail("'", file.string(), "': cannot be written: ", error.message());
}

void write_file(const std::filesystem::path& file, std::span<const std::span<const std::byte>> pieces) {
    write_whole(file, [&](const std::filesystem::path& partial) {
        errno = 0;
        std::ofstream out(partial, std::ios::binary);
        for (const std::span<const std::byte> piece : pieces)
            out.write(reinterpret_cast<const char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
        out.close();
        if (!out) fail("'", file.string(), "': cannot be written: ", std::generic_category().message(errno));
    });
}

void write_file(const std::filesystem::path& file, std::string_view text) {
    const std::span<const std::byte> piece = std::as_bytes(std::span(text));
    write_file(file, std::span(&piece, 1));
}

}  // namespace twinray
