// SPDX-License-Identifier: MIT
// The kernels that hosts get, as the engine itself makes them.
#pragma once

#include <string>
#include <vector>

#include "engine/core/context.h"
#include "engine/core/kernel.h"

namespace twinray::kernels {

// A module with its specialisation constants. No two have the same name and variant.
struct ListedKernel {
    std::string name, variant;
    KernelDesc desc;
    std::uint32_t args_bytes = 0;
};

// Each once, in the order in which they were made: of both accelerators where the device has them, for every layout,
// level and query, of everything else in the library, and of the path tracer. `desc` is made into a context that runs
// nothing.
struct KernelList {
    std::unique_ptr<Context> context;
    std::vector<ListedKernel> kernels;
};
KernelList list_kernels(const ContextDesc& desc);

// What list_kernels() makes: each accelerator traces one mesh, several, and with all there is; everything else is
// made, or used once where that makes the kernel.
void make_trace_kernels(Context& context);
void make_library_kernels(Context& context);
void make_path_tracer_kernels(Context& context);

// What the constants choose, in words: "compressed4 watertight instances". Not how many invocations make a group, so
// that a kernel keeps its name when that changes.
std::string variant_of(const KernelDesc& desc);

}  // namespace twinray::kernels
