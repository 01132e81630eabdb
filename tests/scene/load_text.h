// Scenes from files that a test writes; PNG and gzip files as strings.
#pragma once

#include <twinray/scene.h>
#include <zlib.h>

#include "tests/scene/temp_dir.h"

namespace twinray::test {

// Loads a scene from a file of that name; the files that it refers to do not exist.
inline Scene load_text(const std::string& content, const std::string& name, const std::optional<dvec3>& origin = {}) {
    const TempDir dir;
    return load_scene(dir.write(name, content), origin);
}

// Expects an Error that names the file and says `part`.
inline void expect_load_error(const std::string& content, const std::string& name, const std::string& part) {
    const std::string message = error_of([&] { load_text(content, name); });
    expect_contains(message, name);
    expect_contains(message, part);
}

// Expects as many warnings as parts, in that order.
inline void expect_warnings(const Scene& scene, const std::vector<std::string>& parts) {
    ASSERT_EQ(scene.warnings.size(), parts.size()) << joined(scene.warnings);
    for (std::size_t i = 0; i < parts.size(); ++i) expect_contains(scene.warnings[i], parts[i]);
}

inline std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(static_cast<std::uint32_t>(crc));
}

// A PNG file. `samples` are big-endian rows without filter bytes; color_type 0 = grey, 2 = RGB, 6 = RGBA.
inline std::string png_bytes(std::uint32_t width, std::uint32_t height, int bit_depth, int color_type,
                             const std::string& samples) {
    std::string rows;
    const std::size_t row_size = samples.size() / height;
    for (std::uint32_t y = 0; y < height; ++y) rows += '\0' + samples.substr(y * row_size, row_size);
    std::string packed(compressBound(rows.size()), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()), rows.size());
    const std::string depth_and_type{static_cast<char>(bit_depth), static_cast<char>(color_type), 0, 0, 0};
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", big_endian(width) + big_endian(height) + depth_and_type) +
           png_chunk("IDAT", packed.substr(0, size)) + png_chunk("IEND", "");
}

inline std::string gzip_bytes(const std::string& bytes) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&stream, bytes.size()) + 32, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

}  // namespace twinray::test
