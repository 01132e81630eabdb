// SPDX-License-Identifier: MIT
// The resources that kernels take, as rows of a table or a file, and compared with an earlier file.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "cli/kernels/kernel_statistics.h"

namespace twinray::kernels {

struct KernelRow {
    std::string device;  // or its family
    std::string driver;  // the one that compiled it, with its version; empty: not told
    std::string kernel, variant;
    KernelFigures figures;
    std::uint32_t subgroup_size = 0;  // 0: not told
};

nlohmann::json to_json(const KernelRow& row);
// Reads rows that `twinray kernels --json` wrote; of other lines, it reads only the driver of each device. Throws Error
// naming the file and the line.
std::vector<KernelRow> read_rows(const std::filesystem::path& file);

// Returns Mesa's release, "26.2" of "NVK Mesa 26.2.6-1": the next compiles otherwise. Empty for drivers not of Mesa.
std::string mesa_release_of(const std::string& driver);
// Returns a sentence for each device of `rows` whose limits come from another release of Mesa.
std::vector<std::string> not_comparable(std::span<const KernelRow> rows, std::span<const KernelRow> limits);

// Returns a sentence for each figure that grew past that of the row of the same name in `limits`, and for each row that
// `limits` lacks. Registers, scratch, shared memory and spills may not grow at all, instructions by `margin`. Passes
// over what is not_comparable().
inline constexpr double instruction_margin = 0.02;
std::vector<std::string> grown(std::span<const KernelRow> rows, std::span<const KernelRow> limits,
                               double margin = instruction_margin);

// Returns columns kernel, specialisation, VGPR, waves, scratch, shared, spills, instructions; empty if not told.
std::string table_of(std::span<const KernelRow> rows);

}  // namespace twinray::kernels
