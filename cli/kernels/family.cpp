// SPDX-License-Identifier: MIT
#include "cli/kernels/family.h"

#include <cstdlib>
#include <filesystem>

#include "engine/core/error.h"

namespace twinray::cli {

std::string find_radv() {
    constexpr const char* folders[] = {"/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d",
                                       "/etc/vulkan/icd.d", "/usr/local/etc/vulkan/icd.d"};
    for (const char* folder : folders) {
        std::error_code none;
        for (const auto& file : std::filesystem::directory_iterator(folder, none)) {
            const std::string name = file.path().filename().string();
            if (name.starts_with("radeon_icd") && name.ends_with(".json")) return file.path().string();
        }
    }
    return {};
}

void pretend_family(const std::string& family) {
    const std::string manifest = find_radv();
    if (manifest.empty())
        fail("family '", family, "': Mesa's driver RADV is not installed (Debian: apt-get install mesa-vulkan-drivers)");
    // The second name is for loaders before 1.3.207.
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) setenv(name, manifest.c_str(), 1);
    setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
}

}  // namespace twinray::cli
