// SPDX-License-Identifier: MIT
#include "engine/core/cpu_vectors.h"

#include <algorithm>
#include <cstdlib>
#include <thread>

namespace twinray {

unsigned count_cpu_threads() {
    const char* text = std::getenv("LP_NUM_THREADS");
    const long wanted = text ? std::strtol(text, nullptr, 10) : 0;
    if (wanted > 0) return static_cast<unsigned>(std::min(wanted, 1024L));
    return std::max(1u, std::thread::hardware_concurrency());
}

bool has_512_bit_vectors() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

int lavapipe_release(const DeviceProperties& device) {
    constexpr std::string_view mesa = "Mesa ";
    const std::size_t at = device.driver.find(mesa);
    if (!device.name.starts_with("llvmpipe") || at == std::string::npos) return 0;
    return std::atoi(device.driver.c_str() + at + mesa.size());
}

bool takes_any_vector_width(const DeviceProperties& device) {
    constexpr int first_of_one_width = 26;
    const int release = lavapipe_release(device);
    return release != 0 && release < first_of_one_width;
}

}  // namespace twinray
