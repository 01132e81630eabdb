// SPDX-License-Identifier: MIT
// The width of vectors that a driver for CPUs computes with.
#pragma once

#include <filesystem>
#include <optional>

namespace twinray {

// Whether this is a CPU with AVX-512 (F, BW, DQ, VL) that the system lets programs use.
bool prefers_512_bit_vectors();

// Where Mesa is to keep code for 512 bits, which is then there; nothing where the width should stay. `is_set`: by the
// user. `caches`: empty where there are none.
std::optional<std::filesystem::path> folder_of_wide_code(bool is_preferred, bool is_set,
                                                         const std::filesystem::path& caches);

}  // namespace twinray
