// SPDX-License-Identifier: MIT
#include "engine/scene/image_checks.h"

#include <algorithm>
#include <numeric>

#include "engine/core/error.h"

namespace twinray {
namespace {

std::uint64_t word_at(std::span<const std::uint8_t> bytes, std::size_t first, std::size_t count) {
    std::uint64_t word = 0;  // big endian
    for (std::size_t i = 0; i < count; ++i) word = word << 8 | bytes[first + i];
    return word;
}

// ITU T.81, B.2.4.2: 16 counts of codes by length, then the codes' values.
std::string fault_of_huffman_tables(std::span<const std::uint8_t> segment) {
    constexpr std::size_t counts_end = 17, most_codes = 256;
    while (segment.size() >= counts_end) {
        const std::span<const std::uint8_t> counts = segment.subspan(1, counts_end - 1);
        const std::size_t codes = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
        if (codes > most_codes) return text("a Huffman table of ", codes, " codes, more than ", most_codes);
        segment = segment.subspan(std::min(counts_end + codes, segment.size()));
    }
    return segment.empty() ? "" : "a Huffman table is cut off";
}

// Without a length: fill bytes, restarts, and what stands for a byte 0xff.
bool is_alone(std::uint8_t marker) { return marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd8) || marker == 0xff; }

// What is behind a line.
std::span<const std::uint8_t> next_line(std::span<const std::uint8_t> bytes) {
    const auto end = std::ranges::find(bytes, '\n');
    return {end == bytes.end() ? end : end + 1, bytes.end()};
}

// What follows the header of a Radiance image, which ends with a line that is empty as a string of C, and one of sizes.
std::span<const std::uint8_t> radiance_rows(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty() && bytes[0] != '\n' && bytes[0] != '\0') bytes = next_line(bytes);
    return next_line(next_line(bytes));
}

// Takes the runs of one channel of a row off `rows`. False: they are cut off.
bool take_runs(std::span<const std::uint8_t>& rows, std::uint64_t width) {
    for (std::uint64_t done = 0; done < width;) {
        if (rows.empty()) return false;
        const std::size_t count = rows[0];
        const bool is_repeated = count > 128;
        done += is_repeated ? count - 128 : count;
        rows = rows.subspan(std::min(rows.size(), 1 + (is_repeated ? 1 : count)));
    }
    return true;
}

}  // namespace

std::string fault_of_png(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t header_end = 29;  // signature, length, "IHDR", width, height, bits, colour
    constexpr std::uint64_t most_expansion = 1032, most_bytes = INT32_MAX;
    if (bytes.size() < header_end || word_at(bytes, 0, 4) != 0x89504e47) return "";
    const std::uint64_t width = word_at(bytes, 16, 4), height = word_at(bytes, 20, 4);
    const std::uint8_t bits = bytes[24], color = bytes[25];
    const std::uint64_t channels = (color & 3) == 3 ? 1 : 1 + (color & 2) + (color >> 2 & 1);
    const std::uint64_t row = (width * bits * channels + 7) / 8 + 1;
    const std::uint64_t most = std::min(most_bytes, most_expansion * bytes.size());
    if (height == 0 || row <= most / height) return "";
    return text("too large: ", width, " x ", height, " pixels, more than its ", bytes.size(), " bytes can hold");
}

// Rows of 8 to 32767 pixels may be runs, of at most 127 pixels in 2 bytes, for each of 4 channels.
bool can_hold_radiance(std::uint64_t bytes, std::uint64_t width, std::uint64_t height) {
    const bool has_runs = width >= 8 && width < 32768;
    const std::uint64_t row = has_runs ? 4 + 4 * 2 * ((width + 126) / 127) : 4 * width;
    return height == 0 || row <= bytes / height;
}

bool has_whole_runs(std::span<const std::uint8_t> bytes, std::uint64_t width, std::uint64_t height) {
    constexpr std::size_t row_head = 4;  // 2, 2 and the width, where the row has runs
    std::span<const std::uint8_t> rows = radiance_rows(bytes);
    for (std::uint64_t row = 0; row < height; ++row) {
        if (rows.size() < row_head || rows[0] != 2 || rows[1] != 2 || rows[2] >= 128) return true;
        rows = rows.subspan(row_head);
        for (int channel = 0; channel < 4; ++channel)
            if (!take_runs(rows, width)) return false;
    }
    return true;
}

std::string fault_of_jpeg(std::span<const std::uint8_t> bytes) {
    constexpr std::uint8_t huffman_tables = 0xc4, end = 0xd9;
    if (bytes.empty() || bytes[0] != 0xff) return "";
    for (std::size_t at = 0; at + 1 < bytes.size();) {
        const std::uint8_t marker = bytes[at + 1];
        if (bytes[at] != 0xff || is_alone(marker)) {
            ++at;
            continue;
        }
        at += 2;
        if (marker == end || at + 2 > bytes.size()) break;
        const std::size_t length = std::max<std::size_t>(word_at(bytes, at, 2), 2);
        if (marker == huffman_tables) {
            const std::span<const std::uint8_t> rest = bytes.subspan(at + 2);
            const std::string fault = fault_of_huffman_tables(rest.first(std::min(length - 2, rest.size())));
            if (!fault.empty()) return fault;
        }
        at += length;
    }
    return "";
}

}  // namespace twinray
