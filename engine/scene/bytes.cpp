// SPDX-License-Identifier: MIT
#include "engine/scene/bytes.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <zlib.h>

#include "engine/core/error.h"

namespace twinray {
namespace {

// Guards against files made to unpack to far more than any machine holds.
constexpr std::size_t MAX_UNPACKED_BYTES = std::size_t(4) << 30;

struct Inflater {
    z_stream stream{};

    explicit Inflater(const std::string& object) {
        constexpr int expect_gzip_header = 16 + MAX_WBITS;
        if (inflateInit2(&stream, expect_gzip_header) != Z_OK) fail("'", object, "': out of memory for unpacking");
    }
    ~Inflater() { inflateEnd(&stream); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
};

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t start) {
    if (bytes.empty()) return start;  // zlib would start anew at null
    return static_cast<std::uint32_t>(crc32_z(start, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

Bytes unpack_gzip(const Bytes& packed, const std::string& object) {
    Inflater inflater(object);
    z_stream& stream = inflater.stream;
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
    while (!base64.empty() && base64.back() == '=') base64.remove_suffix(1);
    Bytes bytes;
    bytes.reserve(base64.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : base64) {
        const int digit = base64_digit(c);
        if (digit < 0) return std::nullopt;
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
        const bool escape =
            uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
        decoded += escape ? static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2])) : uri[i];
        if (escape) i += 2;
    }
    return decoded;
}

std::string lower_suffix(const std::filesystem::path& file) {
    std::string suffix = file.extension().string();
    std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix;
}

}  // namespace twinray
