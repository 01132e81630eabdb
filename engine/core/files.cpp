// SPDX-License-Identifier: MIT
#include "engine/core/files.h"

#include <cerrno>
#include <fstream>
#include <random>
#include <system_error>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr int most_links = 40;  // as many as Linux follows

// Returns the file that the name refers to, which need not exist yet.
std::filesystem::path linked(std::filesystem::path file) {
    std::error_code error;
    for (int i = 0; i < most_links && std::filesystem::is_symlink(file, error); ++i)
        file = file.parent_path() / std::filesystem::read_symlink(file, error);
    return file;
}

[[noreturn]] void fail_to_write(const std::filesystem::path& file, const std::string& reason) {
    fail("'", file.string(), "': cannot be written: ", reason);
}

}  // namespace

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
    const std::filesystem::path target = linked(file);
    std::error_code error;
    const auto status = std::filesystem::status(target, error);
    if (std::filesystem::is_directory(status))
        fail_to_write(file, std::make_error_code(std::errc::is_a_directory).message());
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        write(target);
        return;
    }
    std::filesystem::path partial = target;
    partial += text(".partial-", std::hex, std::random_device{}());
    try {
        write(partial);
        std::filesystem::rename(partial, target, error);
        if (error) fail_to_write(file, error.message());
    } catch (...) {
        std::filesystem::remove(partial, error);
        throw;
    }
}

void write_file(const std::filesystem::path& file, std::span<const std::span<const std::byte>> pieces) {
    write_whole(file, [&](const std::filesystem::path& partial) {
        errno = 0;
        std::ofstream out(partial, std::ios::binary);
        for (const std::span<const std::byte> piece : pieces)
            out.write(reinterpret_cast<const char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
        out.close();
        if (!out) fail_to_write(file, std::generic_category().message(errno));
    });
}

void write_file(const std::filesystem::path& file, std::string_view text) {
    const std::span<const std::byte> piece = std::as_bytes(std::span(text));
    write_file(file, std::span(&piece, 1));
}

}  // namespace twinray
