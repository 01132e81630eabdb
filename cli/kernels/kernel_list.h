// SPDX-License-Identifier: MIT
// The kernels that hosts get, as the engine itself makes them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "cli/kernels/limits.h"
#include "engine/core/context.h"
#include "engine/core/kernel.h"

namespace twinray::kernels {

// A module with its specialisation constants. No two have the same name and variant.
struct ListedKernel {
    std::string name, variant;
    KernelDesc desc;
    std::uint32_t args_bytes = 0;
};

// All kernels, each once, in the order in which they were made: those of both accelerators where the device has them,
// for every layout, level and query, of everything else in the library, and of the path tracer. `desc` is made into a
// context that runs nothing.
struct KernelList {
    std::unique_ptr<Context> context;
    std::vector<ListedKernel> kernels;
};
KernelList list_kernels(const ContextDesc& desc);

// Describes the constants in words: "compressed4 watertight instances". Omits how many invocations make a group, so
// that a kernel keeps its name when that changes.
std::string variant_of(const KernelDesc& desc);

// Rows of `twinray kernels`, in compile.cpp: kernels as the compiler of a device makes them, and what builds of SwTlas
// record and move.

struct BuildRow {
    std::string what;  // "build", "refit"
    std::string layout, quality;
    std::uint64_t dispatches = 0, barriers = 0, copies = 0;
    double read = 0, written = 0;  // bytes per triangle, to compare a time on a device with
};

// Builds one mesh of build_triangles and one instance, by the software accelerator, in each layout and quality. The
// context runs nothing (ContextDesc::watch_kernels).
inline constexpr std::size_t build_triangles = 81'920;
std::vector<BuildRow> list_builds(Context& context);

std::string table_of(std::span<const BuildRow> rows);
nlohmann::json to_json(const BuildRow& row, const std::string& device);

// The kernels of list_kernels(), as the compiler of one device makes them.
struct CompiledKernels {
    std::string device;  // or its family
    std::string name, driver;
    std::vector<KernelRow> rows;   // in the order of the list
    std::vector<BuildRow> builds;  // none with a filter
};

// Compiles for the device of `desc`, or, if `family` is not empty, for that family, which is in effect (see family.h).
// `filter`: only kernels with this in their name or variant; "": all.
CompiledKernels compile_kernels(ContextDesc desc, const std::string& family, const std::string& filter);

}  // namespace twinray::kernels
