// SPDX-License-Identifier: MIT
// What kernels take, as rows of a table, of a file, and compared with an earlier one.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "validation/kernels/kernel_statistics.h"

namespace twinray::kernels {

struct KernelRow {
    std::string device;  // or its family
    std::string kernel, variant;
    KernelFigures figures;
    std::uint32_t subgroup_size = 0;  // 0: not told
};

nlohmann::json to_json(const KernelRow& row);
// Of what `twinray kernels --json` wrote; other lines are passed over. Throws Error naming the file and the line.
std::vector<KernelRow> read_rows(const std::filesystem::path& file);

// One sentence for each figure that grew past that of the row of the same name in `limits`, and for each row that has
// none there. Registers, scratch and shared memory may not grow at all, instructions by `margin`.
inline constexpr double instruction_margin = 0.02;
std::vector<std::string> grown(std::span<const KernelRow> rows, std::span<const KernelRow> limits,
                               double margin = instruction_margin);

// Columns kernel, specialisation, VGPR, waves, scratch, shared, instructions; what is not told is empty.
std::string table_of(std::span<const KernelRow> rows);

}  // namespace twinray::kernels
