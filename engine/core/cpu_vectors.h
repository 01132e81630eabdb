// SPDX-License-Identifier: MIT
#pragma once

namespace twinray {

// Whether this is an Intel CPU with AVX-512 (F, BW, DQ, VL) that the system lets programs use.
bool prefers_512_bit_vectors();

// Has Mesa's CPU driver, lavapipe, compute with vectors of 512 bits where prefers_512_bit_vectors(). Left to itself it
// takes 256 bits, but 512 for eight addresses; with these in its registers such a core has two vector units in place of
// three. With 512 bits throughout, SwTlas traces rays 1.6 to 2 times as fast and the driver's own ray queries 1.1
// to 1.3 times; its ray tracing pipelines, which HwTlas takes where there are no ray queries, 0.7 times. (On Zen 4,
// which computes 512 bits in two steps, SwTlas was as fast with either.) It is for programs that compute alone:
// Mesa 25.0's rasteriser crashes with 512 bits.
//
// Sets LP_NATIVE_VECTOR_WIDTH for this process. Mesa keeps compiled code between runs and does not tell widths apart,
// so MESA_SHADER_CACHE_DIR is set, too, to a folder beside that of pipelines. What the user has set stays. It changes
// the environment: to be called before other threads and the first Context.
void widen_cpu_vectors();

}  // namespace twinray
