// SPDX-License-Identifier: MIT
// The statistics that a driver gives of a kernel that it has compiled.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/kernel.h"

namespace twinray {

struct Statistic {
    std::string name;  // in the driver's words
    std::variant<bool, std::int64_t, std::uint64_t, double> value;
};

struct KernelStatistics {
    std::vector<Statistic> told;      // empty if the driver gives none
    std::uint32_t subgroup_size = 0;  // 0: not told
};

// Compiles the kernel and frees it. Needs a context with ContextDesc::watch_kernels. Throws Error naming the kernel if
// it cannot be compiled.
KernelStatistics compile_for_statistics(Context& context, const KernelDesc& desc, std::uint32_t args_bytes);

// Drivers report these under names of their own; empty if this driver does not.
struct KernelFigures {
    std::optional<std::uint64_t> vgprs;          // registers of a lane; Turnip's are of four words
    std::optional<std::uint64_t> sgprs;          // registers of a subgroup
    std::optional<std::uint64_t> waves;          // subgroups that a unit keeps at a time, at most
    std::optional<std::uint64_t> scratch_bytes;  // memory that stands in for registers: of a subgroup with Mesa's RADV
    std::optional<std::uint64_t> shared_bytes;   // of a group
    std::optional<std::uint64_t> instructions;
    std::optional<std::uint64_t> code_bytes;
    std::optional<std::uint64_t> spills;  // how often a register is kept elsewhere: in memory or in one of another kind

    bool operator==(const KernelFigures&) const = default;
};
// Knows the names of Mesa's drivers and of NVIDIA's, in any case. If one figure has several names, their values add up.
// A value below 0 is none.
KernelFigures figures_of(std::span<const Statistic> told);

}  // namespace twinray
