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
    const char* variable;  // tells the shim the GPU, by
    const char* value;
    const char* says;  // what the name of the device has in it
};

std::span<const Family> all_families();
// Throws Error naming those that there are.
const Family& find_family(const std::string& name);

// Whether this process runs over the family's shim.
bool is_in_effect(const Family& family);

// Runs this program once more, over the family's shim and with its driver alone, and returns its exit status. Throws
// Error where the driver or the shim is not installed, and where the driver ends the process.
int run_again(const Family& family, const std::vector<std::string>& arguments);

// The family's device, as ContextDesc::device. Throws Error where shim or driver know no such GPU. Only where
// is_in_effect().
std::string find_device(const Family& family);

}  // namespace twinray::kernels
