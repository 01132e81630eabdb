// SPDX-License-Identifier: MIT
#include "engine/core/cpu_vectors.h"

#include <cstdlib>

#include "engine/core/pipeline_store.h"

namespace twinray {

bool prefers_512_bit_vectors() {
#if defined(__x86_64__)
    return __builtin_cpu_is("intel") && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

void widen_cpu_vectors() {
    if (!prefers_512_bit_vectors() || std::getenv("LP_NATIVE_VECTOR_WIDTH")) return;
    setenv("LP_NATIVE_VECTOR_WIDTH", "512", 0);
    const std::filesystem::path caches = user_pipeline_folder();
    std::error_code error;
    if (!caches.empty()) std::filesystem::create_directories(caches / "mesa-512", error);
    if (!caches.empty() && !error) setenv("MESA_SHADER_CACHE_DIR", (caches / "mesa-512").c_str(), 0);
}

}  // namespace twinray
