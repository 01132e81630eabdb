// SPDX-License-Identifier: MIT
#include "engine/core/cpu_vectors.h"

#include <twinray/context.h>

#include <cstdlib>

#include "engine/core/pipeline_store.h"

namespace twinray {

bool prefers_512_bit_vectors() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

std::optional<std::filesystem::path> folder_of_wide_code(bool is_preferred, bool is_set,
                                                         const std::filesystem::path& caches) {
    if (!is_preferred || is_set || caches.empty()) return std::nullopt;
    const std::filesystem::path folder = caches / "mesa-512";
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    return error ? std::nullopt : std::optional(folder);
}

void widen_cpu_vectors() {
    const bool is_set = std::getenv("LP_NATIVE_VECTOR_WIDTH") || std::getenv("MESA_SHADER_CACHE_DIR");
    const auto folder = folder_of_wide_code(prefers_512_bit_vectors(), is_set, user_pipeline_folder());
    if (!folder) return;
    setenv("LP_NATIVE_VECTOR_WIDTH", "512", 1);
    setenv("MESA_SHADER_CACHE_DIR", folder->c_str(), 1);
}

}  // namespace twinray
