#include "cli/kernels/kernels.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>

#include "engine/core/context.h"
#include "engine/core/error.h"
#include "engine/core/platform.h"

namespace twinray::kernels {
namespace {

constexpr const char* amd_shim = "libamdgpu_noop_drm_shim.so";
constexpr const char* nvidia_shim = "libnouveau_noop_drm_shim.so";
constexpr const char* qualcomm_shim = "libfreedreno_noop_drm_shim.so";

constexpr Family families[] = {
    {"navi10", "AMD RDNA 1", "RADV", "radeon_icd", amd_shim, "AMDGPU_GPU_ID", "navi10", "NAVI10"},
    {"navi21", "AMD RDNA 2", "RADV", "radeon_icd", amd_shim, "AMDGPU_GPU_ID", "navi21", "NAVI21"},
    {"navi31", "AMD RDNA 3", "RADV", "radeon_icd", amd_shim, "AMDGPU_GPU_ID", "navi31", "NAVI31"},
    {"gfx1201", "AMD RDNA 4", "RADV", "radeon_icd", amd_shim, "AMDGPU_GPU_ID", "gfx1201", "GFX1201"},
    {"turing", "NVIDIA Turing", "NVK", "nouveau_icd", nvidia_shim, "NOUVEAU_CHIPSET", "162", "NVK"},
    {"ampere", "NVIDIA Ampere", "NVK", "nouveau_icd", nvidia_shim, "NOUVEAU_CHIPSET", "172", "NVK"},
    {"ada", "NVIDIA Ada", "NVK", "nouveau_icd", nvidia_shim, "NOUVEAU_CHIPSET", "192", "NVK"},
    {"blackwell", "NVIDIA Blackwell", "NVK", "nouveau_icd", nvidia_shim, "NOUVEAU_CHIPSET", "1b2", "NVK"},
    {"adreno740", "Qualcomm Adreno 740", "Turnip", "freedreno_icd", qualcomm_shim, "FD_GPU_ID", "740", "740"},
};

// Returns the file that names the driver; empty: the usual folders have none.
std::string find_manifest(const std::string& beginning) {
    constexpr const char* folders[] = {"/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d",
                                       "/usr/local/etc/vulkan/icd.d"};
    for (const char* folder : folders) {
        std::error_code none;
        for (const auto& file : std::filesystem::directory_iterator(folder, none)) {
            const std::string name = file.path().filename().string();
            if (name.starts_with(beginning) && name.ends_with(".json")) return file.path().string();
        }
    }
    return {};
}

bool can_be_loaded(const char* library) {
    void* const handle = platform::open_library(library);
    if (handle) platform::close_library(handle);
    return handle != nullptr;
}

std::string in_front(const char* first, const char* others) {
    return others && *others ? text(first, ':', others) : first;
}

// The second name of the driver's manifest is for loaders before 1.3.207.
std::map<std::string, std::string> environment_of(const Family& family, const std::string& manifest) {
    return {{"VK_DRIVER_FILES", manifest},
            {"VK_ICD_FILENAMES", manifest},
            {"LD_PRELOAD", in_front(family.shim, std::getenv("LD_PRELOAD"))},
            {family.variable, family.value}};
}

int index_of_device(const Family& family) {
    const std::vector<DeviceProperties> devices = list_devices();
    const auto found = std::ranges::find_if(
        devices, [&](const DeviceProperties& device) { return device.name.find(family.says) != std::string::npos; });
    return found == devices.end() ? -1 : static_cast<int>(found - devices.begin());
}

// A shim ends its process if it does not know the GPU, so a child process asks.
bool has_device(const Family& family) {
    const auto end = platform::run_program({{}, {"devices"}, {}, true});
    return end && end->fault.empty() && end->status == 0 && index_of_device(family) >= 0;
}

}  // namespace

std::span<const Family> all_families() { return families; }

const Family& find_family(const std::string& name) {
    const auto found = std::ranges::find(families, name, &Family::name);
    if (found != std::end(families)) return *found;
    std::string names;
    for (const Family& family : families) names += text(names.empty() ? "" : ", ", family.name);
    fail("there is no family '", name, "'; there are ", names);
}

bool is_in_effect(const Family& family) {
    const char* value = std::getenv(family.variable);
    const char* libraries = std::getenv("LD_PRELOAD");
    return value && libraries && value == std::string_view(family.value) &&
           std::string_view(libraries).find(family.shim) != std::string_view::npos;
}

int run_again(const Family& family, const std::vector<std::string>& arguments) {
    const std::string manifest = find_manifest(family.manifest);
    if (manifest.empty())
        fail("family '", family.name, "' is not available: Mesa's driver ", family.driver,
             " is not installed (Debian: apt-get install mesa-vulkan-drivers; Debian 12 has only RADV)");
    if (!can_be_loaded(family.shim))
        fail("family '", family.name, "' is not available: ", family.shim,
             " is not installed (Debian: apt-get install mesa-drm-shim)");
    std::cout.flush();
    const auto end = platform::run_program({{}, arguments, environment_of(family, manifest)});
    if (!end || !end->fault.empty())
        fail("family '", family.name, "': a signal ended the process that compiled for it; check that ", family.shim,
             " and the driver ", family.driver, " are of the same version of Mesa");
    return end->status;
}

std::string find_device(const Family& family) {
    if (!has_device(family))
        fail("family '", family.name, "' is not available: this Mesa's ", family.shim, " or its driver ", family.driver,
             " does not know ", family.what, " (", family.variable, '=', family.value,
             "), or they are of different versions of Mesa");
    return std::to_string(index_of_device(family));
}

}  // namespace twinray::kernels
