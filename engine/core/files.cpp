#include "engine/core/files.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <random>
#include <system_error>

#include <zlib.h>

#include "engine/core/error.h"
#include "engine/core/platform.h"

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

// Guards against files made to unpack to far more than any machine holds.
constexpr std::size_t MAX_UNPACKED_BYTES = std::size_t(4) << 30;

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

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t start) {
    if (bytes.empty()) return start;  // zlib would start anew at null
    return static_cast<std::uint32_t>(crc32_z(start, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

Bytes unpack_gzip(const Bytes& packed, const std::string& object) {
    constexpr int expect_gzip_header = 16 + MAX_WBITS;
    z_stream stream{};
    if (inflateInit2(&stream, expect_gzip_header) != Z_OK) fail("'", object, "': out of memory for unpacking");
    const std::unique_ptr<z_stream, decltype(&inflateEnd)> end(&stream, &inflateEnd);
    std::array<std::uint8_t, 1 << 16> chunk;
    Bytes bytes;
    std::size_t fed = 0;
    int status = Z_OK;
    while (status != Z_STREAM_END) {
        if (stream.avail_in == 0) {  // zlib counts in 32 bits
            const std::size_t part = std::min<std::size_t>(packed.size() - fed, 1u << 30);
            stream.next_in = const_cast<Bytef*>(packed.data() + fed);
            stream.avail_in = static_cast<uInt>(part);
            fed += part;
        }
        stream.next_out = chunk.data();
        stream.avail_out = static_cast<uInt>(chunk.size());
        status = inflate(&stream, Z_NO_FLUSH);
        if (status == Z_BUF_ERROR) fail("'", object, "': the gzip data is truncated");
        if (status != Z_OK && status != Z_STREAM_END)
            fail("'", object, "': not valid gzip data (", stream.msg ? stream.msg : "damaged", ")");
        bytes.insert(bytes.end(), chunk.data(), stream.next_out);
        if (bytes.size() > MAX_UNPACKED_BYTES) fail("'", object, "': unpacks to more than 4 GiB");
    }
    return bytes;
}

Bytes read_packed_file(const std::filesystem::path& file) {
    Bytes bytes = read_file(file);
    return lower_suffix(file) == ".gz" ? unpack_gzip(bytes, file.string()) : bytes;
}

std::optional<Bytes> decode_base64(std::string_view base64) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    while (!base64.empty() && base64.back() == '=') base64.remove_suffix(1);
    Bytes bytes;
    bytes.reserve(base64.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : base64) {
        const std::size_t digit = digits.find(c);
        if (digit == digits.npos) return std::nullopt;
        bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xfffffu;  // at most 6 + 6 bits are pending
        bit_count += 6;
        if (bit_count < 8) continue;
        bit_count -= 8;
        bytes.push_back(static_cast<std::uint8_t>(bits >> bit_count));
    }
    return bytes;
}

std::string decode_percent(std::string_view uri) {
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        std::uint8_t value = 0;
        const char* const end = uri.data() + i + 3;
        const bool escape = uri[i] == '%' && i + 2 < uri.size() && std::from_chars(end - 2, end, value, 16).ptr == end;
        decoded += escape ? static_cast<char>(value) : uri[i];
        if (escape) i += 2;
    }
    return decoded;
}

std::string lower_suffix(const std::filesystem::path& file) { return lowered(file.extension().string()); }

TemporaryFolder::TemporaryFolder() : path_(platform::make_temporary_folder()) {}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace twinray
