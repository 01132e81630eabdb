// SPDX-License-Identifier: MIT
// Kernels compiled for a device, and what its compiler says.
#pragma once

#include "cli/kernels/builds.h"
#include "cli/kernels/limits.h"

namespace twinray::kernels {

// What the compiler of one device makes of the kernels of list_kernels().
struct CompiledKernels {
    std::string device;  // or its family
    std::string name, driver;
    std::vector<KernelRow> rows;   // in the order of the list
    std::vector<BuildRow> builds;  // none with a filter
};

// For the device of `desc`, or for the family, which is in effect (see family.h), where it is not empty. `filter`: only
// kernels with this in their name or variant; "": all.
CompiledKernels compile_kernels(ContextDesc desc, const std::string& family, const std::string& filter);

}  // namespace twinray::kernels
