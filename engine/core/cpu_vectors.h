// SPDX-License-Identifier: MIT
// The width of vectors that a driver for CPUs computes with.
#pragma once

#include <filesystem>
#include <optional>

namespace twinray {

// Whether this is a CPU with AVX-512 (F, BW, DQ, VL) that the system lets programs use.
bool prefers_512_bit_vectors();

// Has Mesa's driver for CPUs compute with vectors of 512 bits where prefers_512_bit_vectors(). Left to itself it
// takes 256 bits, but 512 for eight addresses, and Intel's cores run all else more slowly beside these. With 512 bits
// throughout, SwTlas traces rays 1.5 to 2 times as fast there and the driver's own ray queries 1.1 to 1.3 times; its
// ray tracing pipelines, which HwTlas takes where there are no ray queries, 0.7 times. On Zen 4, which computes 512
// bits in two steps, SwTlas gains less, 1.0 to 1.1, and ray queries lose, 0.8 to 0.95. It is for programs that compute
// alone: Mesa 25.0's rasteriser crashes with 512 bits.
//
// Sets LP_NATIVE_VECTOR_WIDTH for this process and those it starts. Mesa keeps compiled code between runs and does not
// tell widths apart, so MESA_SHADER_CACHE_DIR is set, too, to a folder beside that of pipelines. Does nothing where the
// user has set one of them, or where there can be no such folder. To be called before other threads and the first
// Context.
void widen_cpu_vectors();

// Where Mesa is to keep code for 512 bits, which is then there; nothing where the width should stay. `is_set`: by the
// user. `caches`: empty where there are none.
std::optional<std::filesystem::path> folder_of_wide_code(bool is_preferred, bool is_set,
                                                         const std::filesystem::path& caches);

}  // namespace twinray
