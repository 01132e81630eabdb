// SPDX-License-Identifier: MIT
#include "validation/kernels/family.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "engine/core/context.h"
#include "engine/core/error.h"

namespace twinray::kernels {

std::string find_radv() {
    constexpr const char* folders[] = {"/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d",
                                       "/usr/local/etc/vulkan/icd.d"};
    for (const char* folder : folders) {
        std::error_code none;
        for (const auto& file : std::filesystem::directory_iterator(folder, none)) {
            const std::string name = file.path().filename().string();
            if (name.starts_with("radeon_icd") && name.ends_with(".json")) return file.path().string();
        }
    }
    return {};
}

namespace {

// RADV ends a process in which it is told of a family that it does not know: a child asks it.
bool knows_family() {
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDERR_FILENO);
        _exit(list_devices().empty() ? 1 : 0);
    }
    int status = 0;
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

void pretend_family(const std::string& family) {
    const std::string manifest = find_radv();
    if (manifest.empty())
        fail("family '", family,
             "': Mesa's driver RADV is not installed (Debian: apt-get install mesa-vulkan-drivers)");
    // The second name is for loaders before 1.3.207.
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) setenv(name, manifest.c_str(), 1);
    setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
    if (!knows_family())
        fail("family '", family, "': RADV knows no such GPU; navi10, navi21, navi31 and gfx1201, for example, it does");
}

}  // namespace twinray::kernels
