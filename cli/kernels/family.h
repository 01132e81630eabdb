// SPDX-License-Identifier: MIT
// GPUs that are not there: Mesa's drivers compile for them over a shim, a library that answers for the kernel's side.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace twinray::kernels {

struct Family {
    const char* name;      // as users write it
    const char* what;      // "NVIDIA Ampere"
    const char* driver;    // "NVK"
    const char* manifest;  // begins the name of the file by which the Vulkan loader finds the driver
    const char* shim;      // of Debian's package mesa-drm-shim
    const char* variable;  // set to `value`, tells the shim the GPU
    const char* value;
    const char* says;  // part of the device's name
};

std::span<const Family> all_families();
// Throws Error naming all families if there is none of this name.
const Family& find_family(const std::string& name);

// Returns whether this process runs over the family's shim.
bool is_in_effect(const Family& family);

// Runs this program once more, over the family's shim and with its driver alone, and returns its exit status. Throws
// Error where the driver or the shim is not installed, and where the driver ends the process.
int run_again(const Family& family, const std::vector<std::string>& arguments);

// Returns the family's device, as ContextDesc::device. Throws Error if shim or driver know no such GPU. Call it only if
// is_in_effect().
std::string find_device(const Family& family);

}  // namespace twinray::kernels
