// SPDX-License-Identifier: MIT
// What kernels take, as rows of a table, of a file, and compared with an earlier one.
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
    std::string driver;  // whose compiler it is, with its version; empty: not told
    std::string kernel, variant;
    KernelFigures figures;
    std::uint32_t subgroup_size = 0;  // 0: not told
};

nlohmann::json to_json(const KernelRow& row);
// Reads rows that `twinray kernels --json` wrote; it passes over other lines but for the driver of each device. Throws
// Error naming the file and the line.
std::vector<KernelRow> read_rows(const std::filesystem::path& file);

// Mesa's release, "26.2" of "NVK Mesa 26.2.6-1": the next one compiles otherwise. Empty: it is none of Mesa's drivers.
std::string mesa_release_of(const std::string& driver);
// One sentence for each device of `rows` whose limits another release of Mesa told.
std::vector<std::string> not_comparable(std::span<const KernelRow> rows, std::span<const KernelRow> limits);

// One sentence for each figure that grew past that of the row of the same name in `limits`, and for each row that has
// none there. Registers, scratch, shared memory and spills may not grow at all, instructions by `margin`. Passes over
// what is not_comparable().
inline constexpr double instruction_margin = 0.02;
std::vector<std::string> grown(std::span<const KernelRow> rows, std::span<const KernelRow> limits,
                               double margin = instruction_margin);

// Columns kernel, specialisation, VGPR, waves, scratch, shared, spills, instructions; what is not told is empty.
std::string table_of(std::span<const KernelRow> rows);

}  // namespace twinray::kernels
