// SPDX-License-Identifier: MIT
#include "engine/core/cpu_vectors.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "engine/core/pipeline_store.h"

namespace twinray {
namespace {

constexpr int first_mesa_of_one_width = 26;
constexpr unsigned most_seconds_to_look = 10;

// In a process of its own, since a driver that was loaded keeps the width that it found.
bool drivers_here_take_any_width() {
    const pid_t child = fork();
    if (child == 0) {
        // Another thread of this process may have held a lock that loading a driver wants.
        std::signal(SIGALRM, SIG_DFL);
        alarm(most_seconds_to_look);
        try {
            _exit(std::ranges::any_of(list_devices(), takes_any_vector_width) ? EXIT_SUCCESS : EXIT_FAILURE);
        } catch (...) {
            _exit(EXIT_FAILURE);
        }
    }
    int status = 0;
    pid_t ended = 0;
    do ended = waitpid(child, &status, 0);
    while (ended < 0 && errno == EINTR);
    return child > 0 && ended == child && WIFEXITED(status) && WEXITSTATUS(status) == EXIT_SUCCESS;
}

}  // namespace

int lavapipe_release(const DeviceProperties& device) {
    constexpr std::string_view mesa = "Mesa ";
    const std::size_t at = device.driver.find(mesa);
    if (!device.name.starts_with("llvmpipe") || at == std::string::npos) return 0;
    return std::atoi(device.driver.c_str() + at + mesa.size());
}

bool takes_any_vector_width(const DeviceProperties& device) {
    const int release = lavapipe_release(device);
    return release != 0 && release < first_mesa_of_one_width;
}

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
    if (!folder || !drivers_here_take_any_width()) return;
    setenv("LP_NATIVE_VECTOR_WIDTH", "512", 1);
    setenv("MESA_SHADER_CACHE_DIR", folder->c_str(), 1);
}

}  // namespace twinray
