// SPDX-License-Identifier: MIT
#include "engine/core/cpu_threads.h"

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

}  // namespace twinray
