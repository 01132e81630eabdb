// SPDX-License-Identifier: MIT
// What stb_image does not look at before it writes or allocates.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace twinray {

// Each returns what is wrong, "" where nothing is or the bytes are of another format.

// Its size: deflate makes at most 1032 bytes of one, and stb_image counts them in 31 bits.
std::string fault_of_png(std::span<const std::uint8_t> bytes);
// Its Huffman tables, anywhere before its end: one of more than 256 codes is written past its room.
std::string fault_of_jpeg(std::span<const std::uint8_t> bytes);
// Of a Radiance image, whether so many bytes can hold its pixels: stb_image makes black ones of what is missing.
bool can_hold_radiance(std::uint64_t bytes, std::uint64_t width, std::uint64_t height);
// Whether the runs of its rows end before the bytes do: behind them stb_image reads empty runs for ever.
bool has_whole_runs(std::span<const std::uint8_t> bytes, std::uint64_t width, std::uint64_t height);

}  // namespace twinray
